"""The services of a NAO, as NAOqi programs call them, done by a virtual robot."""
