"""The sentences for what can go wrong in a program, with places for values, and what to try."""

from __future__ import annotations

from dataclasses import dataclass

LOOK = "Look at the block that is marked: what does it get?"
SHOW_VALUES = "Run again and watch the values of the variables."
CONVERT = "Turn the text into a number, or the number into a text, with a block that does that."
ASK_LENGTH = "Ask first how many items there are, and take only those."
ASK_EMPTY = "Ask first whether the list is empty."
CHECK_LIST = "Check what the list holds at that moment."
CHECK_NUMBER = "Check the number: the first item is number 1."
GIVE_FIRST = "Give the variable a value where the program starts."
CHECK_NAME = "Check the spelling of the name."
TEST_ZERO = "Ask with an “if” whether it is zero before you divide."
CHECK_RANGE = "Check that the first number is not larger than the second."
TYPE_NUMBER = "Write digits only, with a dot where it is not whole."
STOP_GROWING = "Look for a loop that makes the number larger and larger."
CHECK_END = "Look for an own block that runs itself and never stops to do so."
CHECK_CODE = "Check the Python that was written by hand in this line."
NO_NAN = "Check the calculation that the number comes from."


@dataclass(frozen=True)
class Told:
    """What to say about an error: of this type, if what Python says about it is like ``pattern``.

    A place in the sentence is a group of the pattern, or a value of the line that failed; where
    that is not known, a later sentence is taken.
    """

    error: type[BaseException]
    pattern: str
    sentence: str
    steps: tuple[str, ...]


_SUMS = r"unsupported operand|can only concatenate|can't multiply sequence"
_OUT_OF_RANGE = r"index out of range"

SENTENCES = (
    Told(ZeroDivisionError, "", "A number was divided by zero.", (LOOK, TEST_ZERO, SHOW_VALUES)),
    Told(
        NameError,
        r"'(?P<name>\w+)'",
        'Something called "{name}" was used before it had a value.',
        (GIVE_FIRST, CHECK_NAME),
    ),
    Told(
        IndexError,
        f"string {_OUT_OF_RANGE}",
        "The text “{name}” has {count} letters, and letter {number} was asked for.",
        (CHECK_NUMBER, ASK_LENGTH),
    ),
    Told(
        IndexError,
        "",
        "The list “{name}” has {count} items, and item {number} was asked for.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Told(
        IndexError,
        "",
        "The list “{name}” has {count} items, and item {number_from_end} from the end was asked "
        "for.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Told(
        IndexError,
        "empty (list|sequence|range)",
        "Something was taken from an empty list.",
        (ASK_EMPTY, CHECK_LIST),
    ),
    Told(
        IndexError,
        "",
        "An item was asked for that the list does not have.",
        (CHECK_NUMBER, CHECK_LIST, ASK_LENGTH),
    ),
    Told(
        KeyError,
        "(?P<text>.+)",
        "Nothing is kept under the name {text}.",
        (CHECK_NAME, "Keep something under this name first."),
    ),
    Told(
        TypeError,
        _SUMS,
        "This cannot be worked out: {left} {sign} {right}. On the left is {noun}, on the right "
        "{result}.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        r"unsupported operand .*: '(?P<noun>\w+)' and '(?P<result>\w+)'",
        "This cannot be worked out: on the left is {noun}, on the right {result}.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        r"can only concatenate (?P<noun>\w+) \(not \"(?P<result>\w+)\"\)",
        "This cannot be worked out: on the left is {noun}, on the right {result}.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        "not supported between",
        "It cannot be told which is larger, {left} or {right}: one is {noun}, the other {result}.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        r"not supported between instances of '(?P<noun>\w+)' and '(?P<result>\w+)'",
        "It cannot be told which is larger: one is {noun}, the other {result}.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        r"'(?P<noun>\w+)' object is not (iterable|subscriptable|reversible)|"
        r"object of type '(?P<result>\w+)' has no len",
        "A list belongs here, and this is something else.",
        (LOOK, "Put a list into this place."),
    ),
    Told(
        TypeError,
        r"argument .* must be .*number.*not|must be real number, not (?P<noun>\w+)|"
        r"cannot be interpreted as an integer|bad operand type|doesn't define __round__",
        "A number belongs here, and this is something else.",
        (LOOK, CONVERT),
    ),
    Told(
        TypeError,
        r"(?P<name>\w+)\(\) (missing|takes|got)",
        "“{name}” did not get the values that it needs.",
        (LOOK, "Fill every place of this block."),
    ),
    Told(
        TypeError,
        r"'(?P<noun>\w+)' object is not callable",
        "This was used like a block, but it is {noun}.",
        (CHECK_NAME, CHECK_CODE),
    ),
    Told(
        TypeError,
        "",
        "Texts and numbers were mixed where only one kind fits ({said}).",
        (LOOK, CONVERT),
    ),
    Told(
        ValueError,
        r"(?:could not convert string to float|invalid literal for int.*): '(?P<text>.*)'",
        "The text “{text}” is not a number.",
        (TYPE_NUMBER, "Ask with an “if” what the text is, before it is turned into a number."),
    ),
    Told(
        ValueError,
        "math domain error|expected a (positive|nonnegative) (input|number)|expected a number",
        "This has no result for that number, such as the root of a number below zero.",
        (LOOK, SHOW_VALUES),
    ),
    Told(
        ValueError,
        "empty range",
        "No number lies between the two: the first is larger than the second.",
        (CHECK_RANGE, SHOW_VALUES),
    ),
    Told(
        ValueError,
        r"range\(\) arg 3 must not be zero|slice step cannot be zero",
        "Counting in steps of zero never ends.",
        ("Make the step 1, or any number that is not zero.",),
    ),
    Told(
        ValueError,
        "is not in list|not in tuple|x not in list",
        "The list does not have what was looked for.",
        ("Ask first whether the list has it.", CHECK_LIST),
    ),
    Told(
        ValueError,
        "empty|at least (one|two)|no median",
        "There is no result for a list that has too few items.",
        (ASK_EMPTY, CHECK_LIST),
    ),
    Told(
        ValueError,
        "NaN|integer string conversion",
        "A number cannot be written: it is too long, or it is no number at all.",
        (STOP_GROWING, NO_NAN),
    ),
    Told(ValueError, "", "A value did not fit: {said}.", (LOOK, SHOW_VALUES)),
    Told(
        AttributeError,
        r"'(?P<noun>\w+)' object has no attribute '(?P<name>\w+)'",
        "This has no “{name}”: it is {noun}.",
        (CHECK_NAME, LOOK),
    ),
    Told(OverflowError, "", "A number became too large.", (STOP_GROWING, SHOW_VALUES)),
    Told(RecursionError, "", "The program called itself too many times.", (CHECK_END,)),
    Told(
        MemoryError,
        "",
        "The program needs more memory than there is.",
        ("Look for a loop that makes a list or a text longer and longer.",),
    ),
    Told(
        ModuleNotFoundError,
        r"'(?P<name>[\w.]+)'",
        "The Python package “{name}” is not installed.",
        (CHECK_NAME, "Install it for the Python that runs the program."),
    ),
    Told(
        ImportError,
        r"cannot import name '(?P<name>\w+)'",
        "“{name}” cannot be imported: there is nothing of that name.",
        (CHECK_NAME,),
    ),
    Told(
        FileNotFoundError,
        r"'(?P<text>.*)'",
        "There is no file “{text}”.",
        ("Check the name of the file, and the folder that it is in.",),
    ),
    Told(
        PermissionError,
        r"'(?P<text>.*)'",
        "The file “{text}” may not be used.",
        ("Choose another folder, such as Documents.", "Close other programs that use the file."),
    ),
    Told(SystemExit, "", "The program ended itself with: {said}.", (CHECK_CODE,)),
    Told(SyntaxError, "", "The program is not Python that can run: {said}.", (CHECK_CODE,)),
)
"""The first that fits is said."""

OTHER = Told(BaseException, "", "{error}: {said}.", (LOOK, SHOW_VALUES))
"""For everything else."""
