"""The body of a robot: joints, postures, motion; no network in here.

Enters what moves a body that is described as numbers (``resources/robots``), and the virtual robot
made of it. Another robot is another folder of numbers, not another branch in the code.
"""
