"""Give every canvas its accessible interface, and tell screen readers what happens on it."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtGui import QAccessible, QAccessibleAnnouncementEvent, QAccessibleInterface

from ..scrolling import ScrollingView
from .interfaces import CanvasInterface, focus_event

_is_installed = False


def interface_of(view: ScrollingView) -> CanvasInterface:
    """The interface of a canvas, always the same one."""
    if not isinstance(view.accessible, CanvasInterface):
        view.accessible = CanvasInterface(view)  # Qt holds it by pointer only: Python must keep it
    return view.accessible


def make_accessible(view: ScrollingView) -> None:
    """Let screen readers find the blocks of a canvas, and hear where the keyboard is."""
    global _is_installed
    if not _is_installed:
        QAccessible.installFactory(_factory)
        _is_installed = True
    view.selection.changed.connect(lambda: _tell_focus(view))
    view.layout_changed.connect(lambda: _forget_gone(view))


def announce(view: ScrollingView, text: str) -> None:
    """Let a screen reader say something that has happened."""
    if QAccessible.isActive():
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(view, text))


def _factory(class_name: str, item: QObject | None) -> QAccessibleInterface | None:
    return interface_of(item) if isinstance(item, ScrollingView) else None


def _tell_focus(view: ScrollingView) -> None:
    if not QAccessible.isActive():
        return
    event = focus_event(interface_of(view))
    if event is not None:
        QAccessible.updateAccessibility(event)


def _forget_gone(view: ScrollingView) -> None:
    if isinstance(view.accessible, CanvasInterface):
        view.accessible.forget_gone()
