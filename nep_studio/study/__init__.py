"""The study kit: a usability questionnaire, its score, and what happened in a session; no Qt."""
