"""Programs on their way out of the studio: as Python files and on paper."""
