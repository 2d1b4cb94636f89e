"""The panels around the canvas: nodes, network, sensors, and more."""
