"""Training the gestures of a project, what came of it, and trying them out."""
