"""What is not right yet in the program: found while a person works, listed, shown at its block."""
