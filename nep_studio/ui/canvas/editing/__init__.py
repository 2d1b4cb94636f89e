"""What a person does on the canvas: gestures of the mouse and of fingers, keys, menus, commands."""
