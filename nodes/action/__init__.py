"""Action nodes: they play requests on robots."""
