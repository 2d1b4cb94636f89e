"""Lets programs of the original NEP join our network unchanged: see docs/original_nep.md.

Two generations of the original are in use and speak differently; ``old`` means the one up to
0.5.4.5 (port 7000: also the paper's and nep-js), ``new`` the one from 0.5.4.6 on (port 50000).
"""
