"""The canvas for those who do not see it: what each block is, where it is, what has happened."""
