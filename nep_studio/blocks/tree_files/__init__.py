"""Behaviour trees as files of BehaviorTree.CPP (XML), as Groot and Nav2 write them too.

``elements`` reads XML that may come from anywhere, ``reading`` makes blocks of it, ``writing``
makes it of blocks. Format: https://www.behaviortree.dev/docs/learn-the-basics/xml_format
"""
