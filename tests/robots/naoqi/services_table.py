"""What a NAO's services offer, what ours do, and the page that tells of both."""

from __future__ import annotations

from pathlib import Path

from robots.naoqi.server.module import Module
from robots.naoqi.services.all import Services
from robots.naoqi.services.module import Module as ServiceModule
from robots.naoqi.services.perception import Extractor, PausableExtractor
from robots.naoqi.wire.service import FIRST_UID, description_of

TABLE = Path(__file__).parent / "robot_signatures.txt"
PAGE = """# The NAO on the screen, for programs made for a real one

`nep-studio naoqi` offers a virtual NAO (or Pepper: `--model pepper`) at `tcp://127.0.0.1:9559`,
where programs for a real NAO look for it: those made with the package `qi`, with our own client
(`robots/naoqi/client`), or with anything else that speaks NAOqi's protocol. The studio's own
robots are offered by their node's setting `naoqi_port`; the studio shows what they do either way.

What is true of it:

- A call that waits on a real robot waits here, until the movement, the words or the light has
  ended; it holds no thread. Who gives up (`future.cancel()`) stops the robot; `killAll`,
  `stopMove`, `stopAll` reach it within 200 ms. Movements of one limb come one after the other.
- `stopMove` ends a walk after the step under way, and `moveIsActive` is true until both feet stand
  where they stay. A walk that is killed before that (`killMove`, `killAll`, `killTask`,
  `killTasksUsingResources` with a leg), or the step that ends it, throws the robot over, as NAOqi's
  documentation warns: it lies, `robotHasFallen` is raised, its motors let go until `wakeUp` or a
  posture. Who waits for the end of a walk waits 0.6 s longer, until the weight is back between both
  feet. NAOqi's stopMove ends a walk "at next double support"; it does not say what its
  `moveIsActive` tells in the one with which a walk ends. `moveToward` goes on when the program is
  gone, as on a NAO.
- A `moveTo` in a walk to another place takes that one's place, as NAOqi's own example shows: it is
  seen from where the step under way ends (`getNextRobotPosition`), and the robot does not stand in
  between. A NAO looks 0.8 s ahead, which may be more than a step. All who wait are answered when
  the robot stands; NAOqi does not say when it answers the first.
- Joints keep to their limits, and to their speeds: keys that are too fast are played slower, where
  NAOqi may cut them. A joint whose stiffness is 0 does not move, and nobody is told, as on a NAO.
- What cannot be done is refused in a sentence; its words are ours, not NAOqi's.
- ALMemory has the keys of the sensors, and the events of touch, faces, balls, marks, sounds, words,
  posture, battery and speech: the studio's person, or `/sense_request`, sets them off.
- Animations are ours: NAOqi's paths and tags find the one that fits best
  (`resources/robots/nao/naoqi_animations.toml`).
- Pictures and videos show what stands around it, as PNG files of this computer, and calls tell
  their real paths. It has no microphone: services that need one say so.
- 2,000 requests may wait, programs may use 20,000 names of ALMemory, 128 programs may be connected;
  who wants more gets an error that says so.
- `moveToward` changes its speeds every few steps only; `moveTo` walks at the pace that it has.

The signatures are those of a NAO V6 (NAOqi 2.8); for services marked * those of NAOqi 2.1. Every
service also has the methods of every module: `ping`, `version`, `pCall`, ...
`python tools/robot_pages.py services` makes this page.

| Service | offers | of | not offered |
|---|---|---|---|
"""


def read_table() -> dict[str, set[str]]:
    """The robot's methods by service, as ``name::result(parameters)``."""
    services: dict[str, set[str]] = {}
    name = ""
    for line in TABLE.read_text(encoding="utf-8").splitlines():
        words = line.split()
        if not words or words[0] == "#":
            continue
        if len(words) == 1 or words[1] == "*":
            name = words[0]
            services[name] = set()
        else:
            services[name].add("::".join(words))
    return services


def old_services() -> set[str]:
    """The services of which only an older signature is known."""
    lines = TABLE.read_text(encoding="utf-8").splitlines()
    return {line.split()[0] for line in lines if line.endswith(" *")}


def all_services() -> dict[str, type[ServiceModule]]:
    """Our services by name."""
    assert Services  # every service is known once these are put together
    found: dict[str, type[ServiceModule]] = {}
    waiting = [ServiceModule]
    while waiting:
        for kind in waiting.pop().__subclasses__():
            waiting.append(kind)
            if kind.__name__.startswith("AL"):
                found[kind.__name__] = kind
    return dict(sorted(found.items()))


def methods_of(kind: type) -> set[str]:
    """What a service offers beside what every module does."""
    return signatures_of(kind) - signatures_of(Module)


def signatures_of(kind: type) -> set[str]:
    """All methods of a class of services."""
    methods = description_of(kind).meta.methods.items()
    return {f"{it.name}::{it.returns}{it.parameters}" for uid, it in methods if uid >= FIRST_UID}


def known_of(name: str, kind: type) -> set[str]:
    """What the robot's service of this name offers."""
    table = read_table()
    common = [base.__name__ for base in (Extractor, PausableExtractor) if issubclass(kind, base)]
    return table[name].union(*(table[one] for one in common))


def page() -> str:
    """The page of docs that tells of all services."""
    lines = []
    for name, kind in all_services().items():
        offered, known = methods_of(kind), known_of(name, kind)
        missing = ", ".join(sorted({one.partition("::")[0] for one in known - offered}))
        mark = " *" if name in old_services() else ""
        lines.append(f"| {name}{mark} | {len(offered)} | {len(known)} | {missing} |")
    return PAGE + "\n".join(lines) + "\n"
