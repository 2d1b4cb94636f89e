"""From blocks to Python that a teacher would show, with a map from lines to blocks."""
