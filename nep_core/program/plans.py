"""Reach facts by a plan: the functions of a program that say what they need and make, in order.

A task is a function without a line with “@” above it, in whose first level ``needs(...)`` says what
it needs, and ``makes_true(...)`` and ``makes_untrue(...)`` say what it changes, and do so when it
is called: what it does and what is planned with cannot differ. A value there is one of the
function's own, or is made without calling anything.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from types import CodeType, FunctionType
from typing import Any

from faults import Fault, fault_in, fault_of
from nep_core.errors import FactNotSo, PlanError
from nep_core.wire.messages import PlannedStep, PlanTold

from . import facts
from .facts import FACTS, Fact, Value, fact_of, plain, told_fact
from .planner import Parameter, Pattern, Step, Task, Term, find_plan
from .tasks import CLOCK, current_task
from .values import LOOK, as_text, refuse

MOST_PLANS = 5
"""So often a plan is made anew when a step does not do what it should."""
_WORDS = {
    "needs": facts.needs,
    "makes_true": facts.makes_true,
    "makes_untrue": facts.makes_untrue,
}

# Who runs the program hears of its plans.

Teller = Callable[[PlanTold, str, Sequence[PlannedStep], int, Fault | None], None]
"""Told what happened, the goal in words, the plan, the step that runs (from 1), what is wrong."""


def tell_nobody(
    event: PlanTold, goal: str, plan: Sequence[PlannedStep], step: int, fault: Fault | None
) -> None:
    """A script without a behaviour tells of its plans to nobody."""


_tellers: list[Teller] = [tell_nobody]


def tell_by(teller: Teller) -> None:
    """Let plans be told so from now on."""
    _tellers[:] = [teller]


# What a program says.


def reach(*goals: object) -> None:
    """Make facts true, each a list of its name and values, by what own functions say of themselves.

    A step that fails, or after which facts are not as it makes them, is followed by a new plan,
    without that step if there is one. Raises PlanError when there is no plan, or five have failed.
    """
    wanted = _goal(goals)
    known = _functions(sys._getframe(1).f_globals)  # those of the program that asks
    avoided = frozenset[Step]()
    for _ in range(MOST_PLANS):
        plan = _plan(wanted, known, avoided)
        failed = _follow(plan, wanted, known)
        if failed is None:
            return
        step, error = failed
        avoided |= {step}
    raise PlanError(
        "“{goal}” was not reached: {count} plans did not work. The last step that failed was "
        "“{step}”: {reason}",
        checklist=("Try this step by itself.", "Look at what its own block needs and makes."),
        goal=_told_goal(wanted),
        count=MOST_PLANS,
        step=told_step(step),
        reason=fault_in(error).sentence,
    ) from error


def the_plan(*goals: object) -> list[str]:
    """The steps that would make facts true from now on, each as a text; raises PlanError."""
    known = _functions(sys._getframe(1).f_globals)
    return [told_step(step) for step in _plan(_goal(goals), known, frozenset())]


def told_step(step: Step) -> str:
    """A step in words: its task and its values."""
    name = step.task.name.replace("_", " ")
    return " ".join([name, *(as_text(plain(value)) for value in step.values)])


def _goal(goals: Sequence[object]) -> tuple[Fact, ...]:
    if not goals:
        refuse("Nothing is said that is to be reached.", "Put a fact into the block.")
    return tuple(dict.fromkeys(map(fact_of, goals)))


def _told_goal(goal: Sequence[Fact]) -> str:
    return ", ".join(map(told_fact, goal))


_Known = Mapping[Task, FunctionType]


def _plan(goal: tuple[Fact, ...], known: _Known, avoided: frozenset[Step]) -> list[Step]:
    """A plan from now on; steps that have failed are in it only where nothing else will do."""
    present, tasks = FACTS.present(), list(known)
    if avoided:
        try:
            return find_plan(present, goal, tasks, avoided=avoided, look=_look)
        except PlanError:
            pass  # then a step that has failed may do better now
    return find_plan(present, goal, tasks, look=_look)


def _look() -> float:
    """End or rest when the program is asked to; the seconds of the program."""
    current_task().check()
    CLOCK.hold()
    return CLOCK.now_s()


def _follow(
    plan: Sequence[Step], goal: Sequence[Fact], known: _Known
) -> tuple[Step, Exception] | None:
    """Do the steps of a plan; the first that fails, with its error, or None."""
    words, told = _told_goal(goal), [_as_told(step) for step in plan]
    _tellers[0]("plan_made", words, told, 0, None)
    for number, step in enumerate(plan, start=1):
        current_task().check()
        _tellers[0]("plan_step", words, told, number, None)
        try:
            _do(step, known[step.task])
        except Exception as error:
            fault = fault_of(
                "The step “{step}” did not work: {reason}",
                code="plan_step_failed",
                step=told_step(step),
                reason=fault_in(error).sentence,
            )
            _tellers[0]("plan_step_failed", words, told, number, fault)
            return step, error
    _tellers[0]("plan_done", words, told, 0, None)
    return None


def _do(step: Step, function: FunctionType) -> None:
    """Do a step; raises FactNotSo where its needs are not so before, or its changes after."""
    for need in step.needs():
        facts.needs(*_given(need))
    function(*map(plain, step.values))
    for changed, is_made in step.changes().items():
        if FACTS.is_true(changed) is not is_made:
            words = (
                "“{fact}” is not true afterwards." if is_made else "“{fact}” is true afterwards."
            )
            raise FactNotSo(words, checklist=(LOOK,), fact=told_fact(changed))


def _given(fact: Fact) -> tuple[Any, ...]:
    return tuple(map(plain, fact))


def _as_told(step: Step) -> PlannedStep:
    return PlannedStep(step.task.name, [plain(value) for value in step.values])


# The tasks of a program, read from its lines.


def _functions(names: Mapping[str, object]) -> dict[Task, FunctionType]:
    """The functions of a program that say what they make, by the tasks that they are."""
    found: dict[Task, FunctionType] = {}
    for function in list(names.values()):
        if not isinstance(function, FunctionType) or function.__globals__ is not names:
            continue
        code = function.__code__
        if any(names.get(word) is said and word in code.co_names for word, said in _WORDS.items()):
            task = _task(function)
            if task is not None:
                found.setdefault(task, function)
    return found


def _task(function: FunctionType) -> Task | None:
    """The task that a function is, or None: it changes no facts, or nobody can say which."""
    node = _written(function.__code__)
    if node is None or node.decorator_list:  # a rule begins by itself
        return None
    names = [argument.arg for argument in node.args.args]
    needs, changes = list[Pattern](), list[tuple[Pattern, bool]]()
    try:
        for word, arguments in _said(node):
            pattern = tuple(_term(one, names, function.__globals__) for one in arguments)
            if word == "needs":
                needs.append(_stripped(pattern))
            else:
                changes.append((_stripped(pattern), word == "makes_true"))
    except _Unclear:
        return None
    return Task(node.name, tuple(names), tuple(needs), tuple(changes)) if changes else None


def _said(node: ast.FunctionDef) -> Iterator[tuple[str, list[ast.expr]]]:
    """What a function says of facts, whichever way it is gone."""
    for statement in node.body:
        match statement:
            case ast.Expr(value=ast.Call(func=ast.Name(id=word), args=arguments)):
                if word in _WORDS:
                    yield word, arguments
            case ast.Return():
                return


class _Unclear(Exception):
    """A value that is known only when the function is called."""


def _term(node: ast.expr, parameters: Sequence[str], names: Mapping[str, object]) -> Term:
    """A value in what a function says: one of its own, or one that is known already."""
    if isinstance(node, ast.Name) and node.id in parameters:
        return Parameter(parameters.index(node.id))
    inner = list(ast.walk(node))
    if any(isinstance(one, ast.Call | ast.Await | ast.Lambda | ast.Starred) for one in inner):
        raise _Unclear
    if any(isinstance(one, ast.Name) and one.id in parameters for one in inner):
        raise _Unclear
    code = compile(ast.Expression(node), "fact", "eval")
    try:
        return _known(eval(code, dict(names)))
    except Exception as error:
        raise _Unclear from error


def _known(value: object) -> Value:
    return fact_of(["value", value])[1]


def _stripped(pattern: Pattern) -> Pattern:
    """A fact with values of a function; its name is known, and without spaces around it."""
    if not pattern or not isinstance(pattern[0], str) or not pattern[0].strip():
        raise _Unclear
    return (pattern[0].strip(), *pattern[1:])


def _written(code: CodeType) -> ast.FunctionDef | None:
    """The lines of a function as they are written, or None where these are not there."""
    return _definitions(code.co_filename).get((code.co_name, code.co_firstlineno))


@lru_cache(maxsize=8)
def _definitions(path: str) -> dict[tuple[str, int], ast.FunctionDef]:
    """The functions of a file by name and line; read once, for it may be written anew meanwhile."""
    try:
        with open(path, encoding="utf-8") as file:
            tree = ast.parse(file.read())
    except (OSError, SyntaxError, ValueError) as error:
        raise PlanError(
            "The lines of the program cannot be read, which say what its functions make.",
            checklist=("Run the program from its file.",),
            details=str(error),
        ) from error
    return {(n.name, n.lineno): n for n in tree.body if isinstance(n, ast.FunctionDef)}
