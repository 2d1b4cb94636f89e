"""What is shown of a watch or phone that sends: how well, and how it is moved."""
