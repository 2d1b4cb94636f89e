"""Running a project: which nodes it needs, its session, and what is told of them.

Enters what plans, starts, watches and stops, without a window, so that ``nep-studio run`` does
what the button Run does. What a run looks like is in ``ui/running``. No widget, no words of the
window's language: what went wrong is told as data.
"""
