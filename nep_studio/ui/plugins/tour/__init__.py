"""The tour: the first steps, in a project of its own."""

from __future__ import annotations

from nep_studio.ui.host import Host, NewAction, Parts, Plugin


def make(host: Host) -> Parts:
    """The action, first in the Help menu."""
    from .tour import Tour

    tour = Tour(host)
    action = NewAction(
        "tour", "Take the tour", tour.start, "footprints", menu="help", before="help"
    )
    return Parts(actions=[action])


plugin = Plugin("tour", make, order=120, modules=("tour",))
