"""Libraries about robots: their bodies, and the protocol of NAOqi.

No node, no network of ours, no Qt: another project could use them. What makes a robot take
part in a NEP network stands in ``nodes/action``.
"""
