"""The help inside the window: its pages, the panel that shows them, and the way to them."""
