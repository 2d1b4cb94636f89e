"""The body of a NAO: joints, postures, motion; no network in here."""
