"""Values as bytes and back, their types, and the overloads that take them."""

import contextlib
import math
from collections import OrderedDict

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.naoqi.wire.codec import Reader, decode, encode, read_value, reader_of
from robots.naoqi.wire.errors import BadFrame, NoSuchMethod, WrongArguments
from robots.naoqi.wire.metaobject import META_OBJECT, MetaObject, Signature
from robots.naoqi.wire.types import parse_type, type_text_of

SCALARS = (
    st.none()
    | st.booleans()
    | st.integers(-(2**63), 2**64 - 1)
    | st.floats(allow_nan=False)
    | st.text(st.characters(exclude_categories=["Cs"]))
    | st.binary()
)
VALUES = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner) | st.tuples(inner, inner) | st.dictionaries(st.text("ab"), inner),
    max_leaves=20,
)


@given(VALUES)
def test_a_dynamic_value_comes_back_as_it_was(value: object) -> None:
    back = decode("m", encode("m", value))

    assert back == value
    assert type(back) is type(value)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (True, "b"),
        (3, "i"),
        (2**40, "l"),
        (2**63, "L"),
        (0.5, "d"),
        ("a", "s"),
        (None, "v"),
        (b"a", "r"),
        ([1, 2], "[i]"),
        ([1, 2**40], "[l]"),
        ([1, 0.5], "[m]"),
        ([["a"], ["b"]], "[[s]]"),
        ([None, None], "[m]"),
        ((1, "a"), "(is)"),
        ({"a": 1}, "{si}"),
        ({"a": 1, "b": "c"}, "{sm}"),
        (np.array([0.5, 1.5]), "[d]"),
        (np.float32(0.5), "d"),
        (OrderedDict(a=1), "{si}"),
    ],
)
def test_a_value_has_its_type(value: object, text: str) -> None:
    assert type_text_of(value) == text


@pytest.mark.parametrize(
    ("text", "value", "expected"),
    [
        ("[f]", [1, 0.5], [1.0, 0.5]),
        ("[f]", np.array([0.25, 0.5]), [0.25, 0.5]),
        ("i", 2.9, 2),
        ("b", 1, True),
        ("[i]", [1.0, 2.0], [1, 2]),
        ("{s[f]}", {"a": [1]}, {"a": [1.0]}),
        ("+s", None, None),
        ("+s", "a", "a"),
        ("#m", (1, "a"), [1, "a"]),
        ("r", bytearray(b"ab"), b"ab"),
        ("(is)<Pair,number,word>", {"number": 1, "word": "a"}, (1, "a")),
        ("()", (), ()),
        ("v", None, None),
    ],
)
def test_a_value_is_sent_as_the_type_that_is_asked_for(
    text: str, value: object, expected: object
) -> None:
    assert decode(text, encode(text, value)) == expected


def test_the_parts_of_a_named_structure_have_names() -> None:
    pair = decode("(is)<Pair,number,word>", encode("(is)", (1, "a")))

    assert (pair.number, pair.word) == (1, "a")


@pytest.mark.parametrize("name", ["class", "two words", "ª", "", "_x", "1"])
def test_strange_names_of_structures_do_no_harm(name: str) -> None:
    text = f"(is)<{name},{name},{name}>"

    assert decode(text, encode("(is)", (1, "a"))) == (1, "a")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("i", "a"),
        ("i", 2**40),
        ("f", None),
        ("s", 1),
        ("[f]", "ab"),
        ("[f]", 0.5),
        ("(is)", (1,)),
        ("{ss}", ["a"]),
        ("b", "true"),
        ("i", math.inf),
        ("f", 1e300),
        ("o", 3),
        ("m", object()),
        ("m", {1, 2}),
        ("r", "text"),
    ],
)
def test_a_value_that_does_not_fit_is_refused(text: str, value: object) -> None:
    with pytest.raises(WrongArguments):
        encode(text, value)


def test_a_list_that_holds_itself_is_refused() -> None:
    endless: list[object] = []
    endless.append(endless)

    with pytest.raises(WrongArguments):
        encode("m", endless)


TYPES = st.recursive(
    st.sampled_from("vbcCwWiIlLfdsmro"),
    lambda inner: (
        inner.map("[{}]".format)
        | st.tuples(inner, inner).map("{{{0[0]}{0[1]}}}".format)
        | st.lists(inner, max_size=4).map(lambda parts: f"({''.join(parts)})<N,a,b>")
        | inner.map("+{}".format)
    ),
    max_leaves=12,
)


@given(TYPES)
def test_a_type_is_read_as_it_is_written(text: str) -> None:
    assert str(parse_type(text)) == text


@given(TYPES, st.binary(max_size=200))
def test_bytes_are_a_value_or_refused(text: str, data: bytes) -> None:
    with contextlib.suppress(BadFrame):
        decode(text, data)


@given(st.text("[{(<>)}]#+~vbismo,", max_size=60), st.binary(max_size=60))
def test_a_dynamic_value_of_any_type_is_a_value_or_refused(text: str, data: bytes) -> None:
    frame = len(text).to_bytes(4, "little") + text.encode() + data

    with contextlib.suppress(BadFrame):
        decode("m", frame)


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("[v]", b"\xff\xff\xff\x7f"),
        ("[()]", b"\xff\xff\xff\x7f"),
        ("[" + "(" * 20 + "b" + ")" * 20 + "]", b"\xff\xff\x00\x00" + bytes(0xFFFF)),
        ("[i]", b"\xff\xff\xff\xff"),
        ("s", b"\xff\xff\xff\xff"),
        ("[" * 40 + "i" + "]" * 40, bytes(4)),
        ("(" * 20000, b""),
    ],
)
def test_what_announces_more_than_it_brings_takes_no_memory(text: str, data: bytes) -> None:
    with pytest.raises(BadFrame):
        decode(text, data)


def test_values_within_values_without_end_are_refused() -> None:
    data = b"\x01\x00\x00\x00m" * 5000

    with pytest.raises(BadFrame):
        decode("m", data)


@pytest.mark.parametrize(
    ("text", "name", "parameters", "returns"),
    [
        ("goToPosture::b(sf)", "goToPosture", "(sf)", "b"),
        ("stop::v()", "stop", "()", "v"),
        ("touched::(m)", "touched", "(m)", "v"),
        ("level::f", "level", "()", "f"),
        ("pair::(is)<P,a,b>((is)<P,a,b>)", "pair", "((is)<P,a,b>)", "(is)<P,a,b>"),
        ("pCall::m(m)", "pCall", "(m)", "m"),
    ],
)
def test_a_signature_is_read(text: str, name: str, parameters: str, returns: str) -> None:
    signature = Signature.parse(text)

    assert (signature.name, signature.parameters, signature.returns) == (name, parameters, returns)


@pytest.mark.parametrize("text", ["", "name", "::b(s)", "a::q(s)", "a::b(s)x", "a::b(s"])
def test_what_is_no_signature_is_refused(text: str) -> None:
    with pytest.raises(BadFrame):
        Signature.parse(text)


LEDS = [
    "fadeRGB::v(sif)",
    "fadeRGB::v(ssf)",
    "fadeRGB::v(sffff)",
    "insertData::v(si)",
    "insertData::v(sf)",
    "insertData::v(ss)",
    "insertData::v(sm)",
]


@pytest.mark.parametrize(
    ("name", "values", "expected"),
    [
        ("fadeRGB", ("a", 255, 1.0), "(sif)"),
        ("fadeRGB", ("a", "red", 1), "(ssf)"),
        ("fadeRGB", ("a", 1, 0, 0, 1), "(sffff)"),
        ("insertData", ("k", 3), "(si)"),
        ("insertData", ("k", 0.5), "(sf)"),
        ("insertData", ("k", "v"), "(ss)"),
        ("insertData", ("k", [1]), "(sm)"),
        ("insertData::(sm)", ("k", "v"), "(sm)"),
    ],
)
def test_the_overload_that_fits_best_is_taken(name: str, values: tuple, expected: str) -> None:
    meta = MetaObject({uid: Signature.parse(text, uid=uid) for uid, text in enumerate(LEDS)})

    assert meta.overload(name, values).parameters == expected


@pytest.mark.parametrize("values", [(), ("a",), (1, 2, 3), ("a", [], 1.0)])
def test_values_that_no_overload_takes_are_refused(values: tuple) -> None:
    meta = MetaObject({uid: Signature.parse(text, uid=uid) for uid, text in enumerate(LEDS)})

    with pytest.raises(WrongArguments, match="Arguments types did not match for fadeRGB"):
        meta.overload("fadeRGB", values)


def test_a_method_that_is_not_there_is_said_to_be_missing() -> None:
    with pytest.raises(NoSuchMethod):
        MetaObject().overload("dance", ())


def test_a_description_of_an_object_comes_back_as_it_was() -> None:
    meta = MetaObject(
        {100: Signature.parse("say::v(s)", uid=100, description="Says it.")},
        {101: Signature.parse("touched::(m)", uid=101)},
        {102: Signature.parse("level::f", uid=102)},
        "A lamp.",
    )

    back = MetaObject.from_wire(read_value(reader_of(META_OBJECT), Reader(meta.encoded)))

    assert back == meta
