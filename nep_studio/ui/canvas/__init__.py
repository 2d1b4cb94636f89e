"""The block canvas: a layout in plain Python, painted by our own painter, edited by gestures."""
