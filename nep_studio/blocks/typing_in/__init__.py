"""Insert a block by typing its sentence, in any order of words and with values filled in."""
