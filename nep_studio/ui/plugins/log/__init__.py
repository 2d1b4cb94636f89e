"""The log: what happens in the running program, and what the window has told."""
