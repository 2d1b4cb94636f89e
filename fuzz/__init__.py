"""Feeds bad input to every door of the program, and keeps whatever once broke one.

A *target* is one door: what reads a file that somebody brings, what answers a stranger on the
network. Each has *seeds*, small inputs of our own making in ``seeds/<target>/``; the inputs are
these, and endless changes of them. All are fed to the real decoder, or to a real server through a
socket on loopback, in a child process that is watched. What may come of an input is a result or a
``FaultError``, within a second, with at most 50 MB more memory.

What may enter: targets, the changes that fit their formats, and what runs and watches them. What
may not: a decoder of our own, a mock, data of other people, a library that draws inputs (the
changes are made by ``random.Random``, so that a number tells an input again).

``target`` is what a target is, ``mutations`` and ``formats`` make inputs, ``watched`` is the child,
``runner`` starts and watches it, ``targets`` are all the doors.
"""
