"""The robot view: robots from our own shapes in a small room, drawn with or without a GPU."""
