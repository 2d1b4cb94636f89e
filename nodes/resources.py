"""Where the files are that the nodes read: robots, animations, models, sample recordings."""

from __future__ import annotations

from pathlib import Path

from nep_core.errors import NodeStartError
from nep_core.places import RESOURCES_VARIABLE as OVERRIDE
from nep_core.places import resource_folders

NAO = "nao"
BODY_FILE = "body.json"


def resource_folder() -> Path:
    """Return the folder of resources of this checkout, wheel or frozen program.

    The environment variable ``NEP_RESOURCES`` goes first. Raises NodeStartError when none is there.
    """
    for folder in resource_folders():
        if folder.is_dir():
            return folder
    tried = ", ".join(str(folder) for folder in resource_folders())
    raise NodeStartError(
        "The files that come with NEP Studio (its resources folder) are not where they should be.",
        checklist=(
            "Install NEP Studio again.",
            "If you moved that folder yourself, put its place in the variable {override}.",
        ),
        details=f"Looked in: {tried}",
        override=OVERRIDE,
    )


# Which robots there are: each is a folder with its body, its animations and its looks.


def model_folder(model: str) -> Path:
    """Return the folder of a robot, one of those that come with us or a path to one's own.

    Raises NodeStartError with the models that there are.
    """
    robots = resource_folder() / "robots"
    known = sorted(path.parent.name for path in robots.glob(f"*/{BODY_FILE}"))
    if model in known:
        return robots / model
    if model and (Path(model) / BODY_FILE).is_file():
        return Path(model)
    raise NodeStartError(
        'There is no robot model "{model}".',
        checklist=(
            "Choose one of these: {known}.",
            "Or name a folder with a {body_file} in it, such as a changed copy of one of them.",
        ),
        model=model,
        known=", ".join(known),
        body_file=BODY_FILE,
    )


def model_of(folder: Path) -> str:
    """Return how RobotState names the model in a folder: "" a NAO, a name, or the folder's path."""
    shipped = resource_folder() / "robots"
    if folder.parent != shipped:
        return str(folder.resolve())
    return "" if folder.name == NAO else folder.name
