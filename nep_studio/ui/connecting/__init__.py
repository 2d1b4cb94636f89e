"""Connecting a real robot: find it, test the way to it step by step, use it."""
