"""A page that a phone opens in its browser, and that streams how the phone moves."""
