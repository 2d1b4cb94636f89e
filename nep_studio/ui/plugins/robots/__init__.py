"""The robots panel: each robot's body, what it says and does, and a touch by a click."""
