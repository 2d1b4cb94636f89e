"""Watching a program while it runs: where each thread is, what variables hold, when to pause."""
