"""The cue panel: big buttons that send a human state by hand."""
