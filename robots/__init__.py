"""Libraries about robots: their bodies, and the protocol of NAOqi.

Enters what is true of a robot whoever asks it to act. No node, no network of ours, no Qt: another
project could use them. What makes a robot take part in a NEP network stands in ``nodes/action``.
"""
