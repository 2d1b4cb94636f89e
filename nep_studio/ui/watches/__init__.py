"""Connecting a watch or phone: choose the way, follow its steps, see what arrives, use it."""
