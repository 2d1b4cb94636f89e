"""Cognitive nodes: they decide what the robots do."""
