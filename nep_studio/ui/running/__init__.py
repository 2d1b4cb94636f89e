"""Running a project in the window: start, stop, pause, step, and what is heard meanwhile."""
