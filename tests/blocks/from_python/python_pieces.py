"""Pieces of Python as pupils and teachers write them: in a rule, outside of it, at the top."""

# ruff: noqa: E501 - a table of pieces is read more easily with several in a line

from __future__ import annotations

OUTSIDE = [
    *[f"{name} = {value}" for name in ("MAX", "score") for value in ("10", "5", "-1", "2.5", '"a"', "None", "True")],
    *["l = []", "l = [1, 2]", 'd = {"a": 1}', "t = (1, 2)", "s = {1, 2}", "x = y = 3", "a, b = 1, 2", "x = 1; y = 2"],
    *["score: int = 5", "names: list[str] = []", "score = 0  # points", "# only a comment", "# a\n\n# b", "A = 1  # one\n# two\nB = 2"],
    *["import time", "import random", "import math as m", "import os, sys", "from time import sleep", "from random import *"],
    *["from nep_core import *", "import nep_core", "from nep_core import wait as pause", "import random  # dice", "import os.path"],
    *["try:\n    import numpy\nexcept ImportError:\n    numpy = None", "print('loaded')", "x = 5\nx += 1", "del_me = 1\ndel del_me"],
    *["l = []\nwhile len(l) < 3:\n    l.append(1)", "for i in range(3):\n    print(i)", "if True:\n    MODE = 1\nelse:\n    MODE = 2"],
    *["def f():\n    pass", "def add(a, b):\n    return a + b", "def add(a, b=2):\n    return a + b", "def add(*a):\n    return sum(a)"],
    *["def f(**k):\n    return k", "def f(x: int) -> int:\n    return x", "def f():\n    yield 1", "async def f():\n    pass"],
    *["def outer():\n    def inner():\n        return 1\n    return inner()", "score = 5\ndef greet(score):\n    nao.say(score)"],
    *['def f():\n    """Says it."""\n    nao.say("f")', "def f():  # why\n    pass", "# above\ndef f():\n    return 1  # one", "f = lambda x: x + 1"],
    *["n = 1\n\n\ndef f():\n    global n\n    n += 1", "@staticmethod\ndef f():\n    pass", "def f():\n    pass\n\n\ndef f():\n    return 2"],
    *["class Dog:\n    pass", "class Dog:\n    def __init__(self, age):\n        self.age = age", "class A(Exception):\n    x = 1\n\n\nclass B(A):\n    pass"],
    *["squares = [i * i for i in range(5)]", "größe = 3", "名前 = 'Aya'", 'poem = """\n  roses\nviolets\n"""', "text = f'{1 + 2}'", "x = 0xff", "x = 1_000"],
    *["sum = 0", "list = [1]", "input = 3", "wait = 5", "behavior = 3", "nao = 5", "def wait(s):\n    pass", "robot = Robot('Pepper')\nrobot.say('x')"],
    *['def ask():\n    return input("name? ")', "assert MAX", "pass", "with open('x') as f:\n    pass", "match 1:\n    case _:\n        pass"],
]  # fmt: skip

IN_RULE = [
    *["x = 5", "x = 5\nnao.say(str(x))", 'nao.say(f"hi {3 + 4}")', "x: int = 5", "a, b = 1, 2", "x = y = 0", "x = 1; y = 2", "x = 5\nx += 1"],
    *["for i in range(3):\n    nao.say(str(i))", "for i in [1, 2]:\n    wait(0)", "while False:\n    wait(1)", "for c in 'abc':\n    nao.say(c)"],
    *["for _ in range(2):\n    wait(0)  # c", "for i in range(3):\n    wait(0)\nelse:  # d\n    wait(1)", "while True:\n    break", "for i in range(9):\n    if i > 2:\n        break\n    continue"],
    *["if True:\n    wait(1)\nelse:  # hm\n    wait(2)", "if 1 == 1:\n    pass", "if 1 > 2:\n    wait(1)\nelif 2 > 1:  # so\n    wait(2)\nelse:\n    wait(3)"],
    *["nao.say(  # why\n    'x')", "nao.say(\n    'x',\n    gesture='explain',\n)", "# above\nwait(1)", "wait(1)  # behind", "wait(1)\n# below", "wait(1)\n\n\n# end"],
    *["global n  # why\nn = 1", "# count\nglobal n\nn += 1", "n = 1\nglobal m\nm = 2", "if True:\n    global n\n    n = 1"],
    *["try:\n    wait(1)\nexcept ValueError:\n    pass", "try:\n    1 / 0\nexcept ZeroDivisionError as e:\n    nao.say('no')\nfinally:\n    wait(0)"],
    *["import time\ntime.sleep(0)", "from math import pi\nnao.say(str(pi))", "import random\nnao.say(str(random.choice([1])))", "print('a')", "print()"],
    *["l = [1, 2]\nl.append(3)\nnao.say(str(len(l)))", "d = {}\nd['a'] = 1", "l = [x for x in range(3)]", "g = sorted([2, 1], key=lambda v: -v)", "x = [1, 2][0]"],
    *["def inner():\n    wait(0)\ninner()", "def inner(a, b=2):\n    return a\nnao.say(str(inner(1)))", "class A:\n    pass", "return", "return 5", "pass", "pass  # nothing"],
    *['"""A docstring."""\nwait(1)', "x = '''a\n  b\nc'''", "yield 5", "await x", "async def f():\n    pass", "lambda: 1", "del x", "assert True", "raise ValueError('x')"],
    *["x = 5 if True else 6", "x = not True", "x = 1 < 2 < 3", "x = 2 ** -1", "x = 7 // 2 % 2", "x = (1, )", "x = a.b.c", "(yy := 5)", "x = 1_000.50", "x = 'it\\'s'"],
    *["with open('f') as f:\n    pass", "match 1:\n    case 1:\n        wait(1)", "nao.say('a'); nao.say('b')", "if True: wait(1)", "x = input('?')", "when_started()"],
    *["nao.say('ä ß 名')", "größe = 1", "while False:\n\twait(1)", "together(wait, wait)", "def left():\n    wait(0)\n\ndef right():\n    wait(0)\n\ntogether(left, right)"],
    "x = " + " + ".join(["1"] * 500),
    "if 0:\n    pass\n" + "\n".join(f"elif {i}:\n    pass" for i in range(300)),
]  # fmt: skip

TOP = [
    *["# Anna\n# 2026", "#!/usr/bin/env python3\n# -*- coding: utf-8 -*-", '"""My own."""', "'''Several\nlines.'''\nimport time"],
    *["from __future__ import annotations", "import json  # data", "\ufeff# with a mark", "PLAYERS = 2", "# a\nPLAYERS = 2  # b"],
]  # fmt: skip

START = '@behavior.when_started\ndef when_started():\n    nao.say("hi")\n'
MAKE = 'from nep_core import Behavior, Robot\n\nnao = Robot("NAO")\nbehavior = Behavior("T")\n'
RUN = "\n\nbehavior.run()\n"

WHOLE = [
    f'{MAKE}\n\n{START}\n\ndef main():\n    print("go")\n    behavior.run()\n\n\nif __name__ == "__main__":\n    main()\n',
    f'{MAKE}\n\nclass App:\n    def start(self):\n        behavior.run()\n\n\ndef go():\n    App().start()\n\n\n{START}\n\ngo()\nprint("end")\n',
    f'{MAKE}\n\n{START}\nprint("begin"); behavior.run(); print("end")\n',
    f'from nep_core import Behavior, Robot; import random\nnao = Robot("NAO"); behavior = Behavior("T"); SIDES = 6\n\n\n{START}{RUN}',
    f'{MAKE}_private = 0\n__dunder = 1\ntwo__parts = 2\nafter_ = 3\n__author__ = "Mia"\n\n\n@behavior.when_started\ndef when_started():\n    global _private, __dunder, two__parts, after_\n    _private += 1\n    __dunder += 1\n    two__parts *= 2\n    after_ -= 1\n    nao.say(str(_private) + str(two__parts) + str(after_) + __author__){RUN}',
    f"{MAKE}LIVES = 3\npoints = 0\nnames = []\nSPEED = 2.5\n\n\ndef one():\n    return points\n\n\nVALUE = 3\n\n\ndef two():\n    nao.say(str(VALUE))\n\n\nRESULT = one()\n\n\n@behavior.when_started\ndef when_started():\n    global points\n    points = RESULT\n    names.append(SPEED)\n    two(){RUN}",
    f"{MAKE}\n\ndef sign(n):\n    if n > 0:\n        return 'plus'\n    return 'minus'\n\n\ndef maybe(n):\n    if n:\n        return n\n\n\ndef nothing(n):\n    if n:\n        return\n    nao.say('x')\n\n\n@behavior.when_started\ndef when_started():\n    nao.say(sign(-2))\n    nao.say(str(maybe(0)))\n    nothing(1){RUN}",
    f"{MAKE}\n\n@behavior.when_started\ndef when_started():\n    k = 2\n\n    def left():\n        nonlocal k\n        k += 1\n\n    left()\n    nao.say(str(k)){RUN}",
]
"""Programs as people write them whole: who runs the behaviour, in which order all stands."""
