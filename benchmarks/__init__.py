"""Speed and memory, each measured against a reference in the same run."""
