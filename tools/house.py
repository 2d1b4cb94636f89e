"""Measures the house: how many files and lines, how large, and who imports whom.

    .venv/bin/python tools/house.py            as a table
    .venv/bin/python tools/house.py --json     as one JSON object

It reads the source of the packages that make the program; what a file imports only inside
functions, or only for types, is told apart.
"""

from __future__ import annotations

import argparse
import ast
import json
import statistics
import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = ("faults", "nep_core", "nep_studio", "nodes", "robots")
SMALL, LARGE, LARGEST = 60, 600, 800
"""Lines: a smaller file needs a reason, a larger one should be two, none is above the last."""

WHOLES = ("MainWindow", "Canvas")
"""The classes that hold everything; the fewer know them the better."""

AT_IMPORT, LATE, TYPING = "at import", "late", "typing"
WAYS = {
    "at import": (AT_IMPORT,),
    "with late imports": (AT_IMPORT, LATE),
    "with typing imports": (AT_IMPORT, LATE, TYPING),
}
"""Which imports count for a circle."""

Arrows = Mapping[str, set[str]]


@dataclass(frozen=True)
class Known:
    """Who knows a class: parameters of its type, the files of those, files that name it at all."""

    parameters: int
    files_of_parameters: int
    files: int


@dataclass(frozen=True)
class House:
    """What was measured. ``circles`` are the sizes of the groups that import each other."""

    files: int
    lines: int
    mean: float
    median: float
    small: list[str]
    large: list[str]
    largest: list[str]
    with_one_importer: int
    known: dict[str, Known]
    circles: dict[str, list[int]]


@dataclass
class Module:
    """A file of ours: its name as a module, its source, and what it imports in which way."""

    name: str
    path: Path
    text: str
    tree: ast.Module = field(init=False)
    imports: dict[str, set[str]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.tree = ast.parse(self.text)

    @property
    def lines(self) -> int:
        """How long it is."""
        return len(self.text.splitlines())

    @property
    def package(self) -> str:
        """Where its relative imports begin."""
        return self.name if self.path.name == "__init__.py" else self.name.rpartition(".")[0]


def measured(root: Path, packages: tuple[str, ...] = PACKAGES) -> House:
    """Read the packages in a folder, and measure them."""
    modules = modules_in(root, packages)
    sizes = [module.lines for module in modules.values()]

    def places(least: int, most: float = float("inf")) -> list[str]:
        return sorted(
            module.path.relative_to(root).as_posix()
            for module in modules.values()
            if least <= module.lines < most
        )

    return House(
        files=len(modules),
        lines=sum(sizes),
        mean=round(statistics.fmean(sizes), 1),
        median=statistics.median(sizes),
        small=places(0, SMALL),
        large=places(LARGE + 1),
        largest=places(LARGEST + 1),
        with_one_importer=list(importers(modules).values()).count(1),
        known={name: known(name, modules) for name in WHOLES},
        circles={
            way: [len(one) for one in circles(arrows(modules, kinds))]
            for way, kinds in WAYS.items()
        },
    )


def modules_in(root: Path, packages: tuple[str, ...]) -> dict[str, Module]:
    """Every module by its name, its imports read."""
    modules = {}
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            parts = path.relative_to(root).with_suffix("").parts
            name = ".".join(parts).removesuffix(".__init__")
            modules[name] = Module(name, path, path.read_text(encoding="utf-8"))
    for module in modules.values():
        for name, kind in _imports(module):
            target = name if name in modules else name.rpartition(".")[0]
            if target in modules and target != module.name:
                module.imports.setdefault(kind, set()).add(target)
    return modules


def _imports(module: Module) -> Iterator[tuple[str, str]]:
    """The full names that a module imports, each with the way it does so."""
    waiting: list[tuple[ast.AST, str]] = [(module.tree, AT_IMPORT)]
    while waiting:
        node, kind = waiting.pop()
        if isinstance(node, ast.Import):
            yield from ((alias.name, kind) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = module.package.split(".")
            above = above[: len(above) - node.level + 1] if node.level else []
            start = ".".join([*above, *filter(None, [node.module])])
            yield from ((f"{start}.{alias.name}", kind) for alias in node.names)
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            kind = TYPING if kind == TYPING else LATE
        elif isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            waiting += [(child, kind) for child in node.orelse]
            waiting += [(child, TYPING) for child in node.body]
            continue
        waiting += [(child, kind) for child in ast.iter_child_nodes(node)]


def arrows(modules: Mapping[str, Module], kinds: tuple[str, ...]) -> dict[str, set[str]]:
    """Whom each module imports, in these ways."""
    return {
        name: set().union(*(module.imports.get(kind, set()) for kind in kinds))
        for name, module in modules.items()
    }


def importers(modules: Mapping[str, Module]) -> Counter[str]:
    """How many modules import each, in any way."""
    return Counter(
        target
        for targets in arrows(modules, WAYS["with typing imports"]).values()
        for target in targets
    )


def known(name: str, modules: Mapping[str, Module]) -> Known:
    """Who knows a class by its name."""
    modules = {key: module for key, module in modules.items() if name in module.text}
    counts = [
        sum(
            name in _names(argument.annotation)
            for argument in ast.walk(module.tree)
            if isinstance(argument, ast.arg) and argument.annotation is not None
        )
        for module in modules.values()
    ]
    naming = [module for module in modules.values() if name in _names(module.tree)]
    return Known(sum(counts), sum(map(bool, counts)), len(naming))


def _names(tree: ast.AST) -> set[str]:
    """The names in some source, those in annotations that are texts too."""
    found = set[str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            found.add(node.id)
        elif isinstance(node, ast.alias):
            found.add(node.name)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            found.add(node.value)
    return found


def circles(imported: Arrows) -> list[list[str]]:
    """Groups of modules that reach each other, the largest first (Tarjan 1972)."""
    numbers: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: list[str] = []
    found: list[list[str]] = []

    def visit(name: str) -> None:
        numbers[name] = lowest[name] = len(numbers)
        open_.append(name)
        for target in sorted(imported.get(name, ())):
            if target not in numbers:
                visit(target)
                lowest[name] = min(lowest[name], lowest[target])
            elif target in open_:
                lowest[name] = min(lowest[name], numbers[target])
        if lowest[name] == numbers[name]:
            at = open_.index(name)
            found.append(sorted(open_[at:]))
            del open_[at:]

    limit = sys.getrecursionlimit()
    sys.setrecursionlimit(limit + 4 * len(imported))  # a chain may be as long as all modules
    try:
        for name in imported:
            if name not in numbers:
                visit(name)
    finally:
        sys.setrecursionlimit(limit)
    return sorted((one for one in found if len(one) > 1), key=len, reverse=True)


def table(house: House) -> str:
    """The measures for people."""
    lines = [
        f"files                          {house.files}",
        f"lines                          {house.lines}",
        f"mean, median lines of a file   {house.mean:g}, {house.median:g}",
        f"files under {SMALL} lines           {len(house.small)}",
        f"files over {LARGE}, {LARGEST} lines      {len(house.large)}, {len(house.largest)}",
        f"modules with one importer      {house.with_one_importer}",
    ]
    for name, one in house.known.items():
        lines += [
            f"parameters typed {name:<13} {one.parameters} in {one.files_of_parameters} files; "
            f"{one.files} files name it"
        ]
    for way, sizes in house.circles.items():
        told = ", ".join(map(str, sizes)) or "none"
        lines.append(f"circles {way:<22} {told}")
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Print what was measured."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.add_argument("--files", action="store_true", help="name small and large files, circles")
    options = parser.parse_args(arguments)
    house = measured(ROOT)
    print(json.dumps(asdict(house)) if options.json else table(house))
    if options.files:
        _name_files(house)
    return 0


def _name_files(house: House) -> None:
    for title, files in (("under", house.small), ("over", house.large)):
        print(f"\n{title} {SMALL if title == 'under' else LARGE} lines:", *files, sep="\n  ")
    modules = modules_in(ROOT, PACKAGES)
    for way, kinds in WAYS.items():
        for one in circles(arrows(modules, kinds)):
            print(f"\ncircle {way}:", *one, sep="\n  ")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
