"""The driver of a real NAO: requests of programs become calls of NAOqi, and nothing waits."""
