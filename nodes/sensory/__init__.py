"""Sensory nodes: they publish what sensors measure."""
