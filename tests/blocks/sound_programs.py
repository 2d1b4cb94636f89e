"""Programs without problems, and short questions about the problems of programs."""

from __future__ import annotations

from block_building import B, build

from nep_studio.blocks.checks import check

WAIT = B("control.wait")


def karate_node(**parameters):
    return B("nodes.launch", {"parameters": {"gesture": "karate", **parameters}})


def sound(language, *stacks):
    """A program with these rules, with NAO and the karate gesture on the other pages."""
    editor = build(language, *stacks, variables=("x",))
    build(language, [B("robots.robot")], page="robots", editor=editor)
    build(language, [karate_node()], page="nodes", editor=editor)
    return editor


def kinds(editor, language):
    return [problem.kind for problem in check(editor.project, language)]


def only(editor, language):
    (problem,) = check(editor.project, language)
    return problem


def block_of(editor, block_type):
    return next(b.id for b in editor.project.blocks.values() if b.type == block_type)
