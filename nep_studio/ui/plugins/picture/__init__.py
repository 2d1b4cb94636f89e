"""Pictures of programs to keep and to show, with the program inside, to be opened again."""
