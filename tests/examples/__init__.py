"""The nodes in other languages that people start from, and the page that describes the wire."""
