"""The block language as data: definitions, programs, edits, checks and code; no Qt, no network."""
