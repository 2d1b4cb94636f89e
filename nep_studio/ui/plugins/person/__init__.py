"""The simulated human: all that a program can react to, done with the mouse."""
