"""Live curves of watches, phones and any number that a node sends."""
