"""What the help says, read from files: texts, how-to pages, examples, and an index of them."""
