"""What a program that decides is made of: robots, rules, goals, tasks, what the person does.

Enters the API that generated and hand-written programs use. Nothing here knows how a robot
works: requests go out as messages, answers come back as messages.
"""
