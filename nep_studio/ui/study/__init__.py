"""The study kit in the window: the questionnaire, what is recorded, and the results."""
