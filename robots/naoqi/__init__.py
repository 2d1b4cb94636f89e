"""NAOqi, the system of a NAO: its protocol, a robot that speaks it, and how to drive one.

``wire`` is the protocol, ``client`` and ``server`` its two sides, ``services`` what a virtual robot
offers, ``driver`` how a real one is moved. Enters what knows NAOqi's
wire; what a request of a program means for a body is in ``body``.
"""
