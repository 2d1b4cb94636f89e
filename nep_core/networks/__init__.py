"""Networks: how programs find each other, and over what; p2p, broker, direct, zenoh.

Enters what knows endpoints, the master and its registry. ``gateway`` serves programs of the
original NEP, ``security`` says who may take part. Nothing here starts a process.
"""
