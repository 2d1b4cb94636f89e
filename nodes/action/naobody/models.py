"""Which robots there are: each is a folder with its body, its animations and its looks."""

from __future__ import annotations

from pathlib import Path

from nep_core.errors import NodeStartError
from nodes.resources import resource_folder

NAO = "nao"
BODY_FILE = "body.json"


def robot_folder(model: str) -> Path:
    """Return the folder of a model, one of those that come with us or a path to one's own.

    Raises NodeStartError with the models that there are.
    """
    robots = resource_folder() / "robots"
    known = sorted(path.parent.name for path in robots.glob(f"*/{BODY_FILE}"))
    if model in known:
        return robots / model
    if model and (Path(model) / BODY_FILE).is_file():
        return Path(model)
    raise NodeStartError(
        f'There is no robot model "{model}".',
        checklist=(
            f"Choose one of these: {', '.join(known)}.",
            f"Or name a folder with a {BODY_FILE} in it, such as a changed copy of one of them.",
        ),
    )


def model_of(folder: Path) -> str:
    """Return how RobotState names the model in a folder: "" a NAO, a name, or the folder's path."""
    shipped = resource_folder() / "robots"
    if folder.parent != shipped:
        return str(folder.resolve())
    return "" if folder.name == NAO else folder.name
