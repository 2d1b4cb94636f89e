"""The voices of the robots on the screen, where the computer can speak."""
