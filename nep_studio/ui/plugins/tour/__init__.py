"""The tour: five steps over the real window, from the first block to a robot that speaks."""
