"""Perceptual nodes: they turn measurements into words."""
