"""Edits of the project as a whole: its name, its variables, where its stacks lie."""

from __future__ import annotations

from typing import ClassVar

from nep_studio.blocks.errors import EditRefused
from nep_studio.blocks.program import PAGES, Project, Stack, Variable

from .edit import Edit


class MoveStack(Edit, frozen=True):
    """Move a stack on its page, in canvas units."""

    label: ClassVar[str] = "move a stack"
    stack: str
    x: float
    y: float

    def apply(self, project: Project) -> MoveStack:
        """Move the stack."""
        stack = project.stacks.get(self.stack)
        if stack is None:
            raise EditRefused("This stack is not there any more.")
        old = MoveStack(self.stack, stack.x, stack.y)
        stack.x, stack.y = float(self.x), float(self.y)
        project.touch(self.stack)
        return old


class RenameProject(Edit, frozen=True):
    """Give the project another name."""

    label: ClassVar[str] = "rename the project"
    name: str

    def apply(self, project: Project) -> RenameProject:
        """Rename the project."""
        old, project.name = project.name, self.name
        project.changes.whole = True
        return RenameProject(old)


class AddVariable(Edit, frozen=True):
    """Make a variable, at a position of the list of variables."""

    label: ClassVar[str] = "make a variable"
    variable: str
    name: str
    position: int
    scope: str = ""

    def apply(self, project: Project) -> RemoveVariable:
        """Make the variable."""
        if project.variable(self.variable) is not None:
            raise EditRefused("A variable with this id is already there.")
        if not 0 <= self.position <= len(project.variables):
            raise EditRefused("There is no such position in the list of variables.")
        project.variables.insert(self.position, Variable(self.variable, self.name, self.scope))
        project.id_seen(self.variable)
        project.changes.whole = True
        return RemoveVariable(self.variable)


class RemoveVariable(Edit, frozen=True):
    """Delete a variable; blocks that name it stay, and are told by the checks."""

    label: ClassVar[str] = "delete a variable"
    variable: str

    def apply(self, project: Project) -> AddVariable:
        """Delete the variable."""
        variable = _require_variable(project, self.variable)
        position = project.variables.index(variable)
        del project.variables[position]
        project.changes.whole = True
        return AddVariable(variable.id, variable.name, position, variable.scope)


class RenameVariable(Edit, frozen=True):
    """Give a variable another name; blocks name it by its id and follow."""

    label: ClassVar[str] = "rename a variable"
    variable: str
    name: str

    def apply(self, project: Project) -> RenameVariable:
        """Rename the variable."""
        variable = _require_variable(project, self.variable)
        old, variable.name = variable.name, self.name
        project.changes.whole = True
        return RenameVariable(self.variable, old)


class SetScope(Edit, frozen=True):
    """Say where a variable is known: see Variable."""

    label: ClassVar[str] = "change where a variable is known"
    variable: str
    scope: str

    def apply(self, project: Project) -> SetScope:
        """Set the scope."""
        variable = _require_variable(project, self.variable)
        old, variable.scope = variable.scope, self.scope
        project.changes.whole = True
        return SetScope(self.variable, old)


def _require_variable(project: Project, variable_id: str) -> Variable:
    variable = project.variable(variable_id)
    if variable is None:
        raise EditRefused("This variable is not there any more.")
    return variable


# Edits of the list of pages: add, remove, rename, move.


class AddPage(Edit, frozen=True):
    """Add a page for behaviour, at a position of the list of pages."""

    label: ClassVar[str] = "add a page"
    page: str
    title: str
    position: int

    def apply(self, project: Project) -> RemovePage:
        """Add the page."""
        if self.page in project.pages or self.page in PAGES:
            raise EditRefused("A page with this id is already there.")
        _put(project, self.page, [], self.position)
        if self.title:
            project.page_titles[self.page] = self.title
        project.id_seen(self.page)
        project.changes.whole = True
        return RemovePage(self.page)


class RemovePage(Edit, frozen=True):
    """Take an empty page away that was added."""

    label: ClassVar[str] = "delete a page"
    page: str

    def apply(self, project: Project) -> AddPage:
        """Take the page away."""
        position = _require_page(project, self.page)
        if self.page in PAGES:
            raise EditRefused("This page belongs to every project: it cannot be deleted.")
        if project.pages[self.page] or any(n.page == self.page for n in project.notes.values()):
            raise EditRefused("There is something on this page: empty it first.")
        del project.pages[self.page]
        title = project.page_titles.pop(self.page, "")
        project.changes.whole = True
        return AddPage(self.page, title, position)


class RenamePage(Edit, frozen=True):
    """Give a page another title; an empty one is the title that it has by itself."""

    label: ClassVar[str] = "rename a page"
    page: str
    title: str

    def apply(self, project: Project) -> RenamePage:
        """Rename the page."""
        _require_page(project, self.page)
        old = project.page_titles.pop(self.page, "")
        if self.title:
            project.page_titles[self.page] = self.title
        project.changes.whole = True
        return RenamePage(self.page, old)


class MovePage(Edit, frozen=True):
    """Move a page to another position of the list of pages."""

    label: ClassVar[str] = "move a page"
    page: str
    position: int

    def apply(self, project: Project) -> MovePage:
        """Move the page."""
        old = _require_page(project, self.page)
        if not 0 <= self.position < len(project.pages):
            raise EditRefused("There is no such position in the list of pages.")
        _put(project, self.page, project.pages.pop(self.page), self.position)
        project.changes.whole = True
        return MovePage(self.page, old)


def _require_page(project: Project, page: str) -> int:
    """The position of a page, or EditRefused."""
    if page not in project.pages:
        raise EditRefused("This page is not there any more.")
    return list(project.pages).index(page)


def _put(project: Project, page: str, stacks: list[Stack], position: int) -> None:
    pages = list(project.pages.items())
    if not 0 <= position <= len(pages):
        raise EditRefused("There is no such position in the list of pages.")
    pages.insert(position, (page, stacks))
    project.pages.clear()
    project.pages.update(pages)
