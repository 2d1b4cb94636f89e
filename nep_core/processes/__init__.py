"""Nodes as processes: their manifests, how they are started, watched, stopped and logged.

Enters what knows that a node is a process. What a node says goes over ``networks``; what a
program does with robots is in ``program``.
"""
