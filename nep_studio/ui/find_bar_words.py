"""What the subjects of the find bar are called."""

from __future__ import annotations

from nep_studio.blocks.operations.subjects import Subject
from nep_studio.blocks.procedures import parameters, words
from nep_studio.blocks.program import Project


def subject_name(project: Project, subject: Subject) -> str:
    """What a thing is called: variables and own blocks are known by ids."""
    if subject.kind == "variable":
        variable = project.variable(subject.name)
        return variable.name if variable is not None else subject.name
    own, _, parameter = subject.name.partition(".")
    procedure = project.procedures.get(own)
    if subject.kind == "procedure" and procedure is not None:
        return words(procedure)
    if subject.kind == "parameter" and procedure is not None:
        named = {p.id: p.name for p in parameters(procedure)}
        return named.get(parameter, parameter)
    return subject.name
