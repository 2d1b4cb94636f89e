"""The study kit: a usability questionnaire, its score, and what happened in a session; no Qt.

Enters what a researcher gets: records as data and as tables, and nothing that tells who somebody
was. Asking and showing is in ``ui/plugins/study``.
"""
