"""Values that a file or a person may put into a field, the worst we can think of."""

from __future__ import annotations

import math

from hypothesis import strategies as st

TEXTS = (
    "",
    '"',
    "'",
    '"""',
    "'''",
    "\\",
    '\\"',
    '"); import os; os.system("ls"); ("',
    "x\nimport os",
    "x\rimport os",
    "x\r\nimport os",
    "x\x0cimport os",
    "x\x0bimport os",
    "x\x85import os",
    "x\u2028import os",
    "x\u2029import os",
    "\x00",
    "\ud800",
    "a\udfffb",
    "\u202eevil\u202c",
    "\ufeff",
    "class",
    "None",
    "import",
    "match",
    "__import__",
    "__debug__",
    "exec",
    "behavior",
    "Robot",
    "random",
    "part_1",
    "_",
    "1",
    "１",  # noqa: RUF001 a full-width digit, which is a digit to Python
    "ﬁ",
    "größe (cm)",
    "名前",
    "{0}",
    "%s",
    "#",
    "# -*- coding: utf-7 -*-",
    "nao.say()",
    "gesture_karate",
    "x" * 9_999,
)
NUMBERS = (0, -0.0, -1, 2.5, -2.5, 1e-320, 1e15, -(10**15), 10**16, 10**5000, 1e308, -1e308)
NOT_NUMBERS = (math.inf, -math.inf, math.nan)

texts = (
    st.sampled_from(TEXTS)
    | st.text(max_size=40)
    | st.text(st.sampled_from("\"'\\\n\r\x00 #()\u2028ab"), max_size=12)
)
numbers = (
    st.sampled_from(NUMBERS + NOT_NUMBERS)
    | st.integers()
    | st.floats(allow_nan=True, allow_infinity=True)
)
settings_values = st.dictionaries(texts, texts | numbers | st.booleans(), max_size=3)
anything = (
    texts | numbers | st.booleans() | st.none() | settings_values | st.lists(texts, max_size=2)
)
