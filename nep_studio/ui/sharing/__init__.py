"""Lets other computers take part in the network of this one, or this one in theirs."""
