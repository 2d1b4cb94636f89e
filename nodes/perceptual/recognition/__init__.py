"""Recognising gestures in the movement of a wrist; no network in here."""
