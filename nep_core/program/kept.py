"""Variables that are kept over the runs of a program, in a JSON file."""

from __future__ import annotations

import atexit
import json
import logging
import sys
import threading
import time
from pathlib import Path

from faults import Fault, fault_of
from faults.files import write_whole
from nep_core.errors import ValueRefused
from nep_core.program.tables import names_in, table_of
from nep_core.program.variables import Variables

log = logging.getLogger(__name__)

SUFFIX = ".kept.json"
DAMAGED = ".damaged"
LOOK_S = 0.5
"""How often what is kept is compared with the file: so much is lost at most in a crash."""
MOST_BYTES = 50_000_000
"""A larger file was not written by this."""
ENTRIES = "table"
"""Under this name alone are the entries of a table whose keys are not all texts, as in JSON."""

_place: list[Path] = []
_keepers: list[_Keeper] = []
_troubles: list[Fault] = []


class Kept(Variables):
    """Variables that hold at the start of a program what they held at the end of its last run.

    Made with what they hold at first: ``kept = Kept(high_score=0)``. Numbers, texts, truths, lists
    and tables are kept; each change is in the file half a second later.
    """

    def __init__(self, /, **first: object) -> None:
        super().__init__(**first)
        keeper = _Keeper(_place[0] if _place else _beside_the_program(), self.__dict__)
        keeper.read()
        _keepers.append(keeper)
        threading.Thread(target=keeper.keep_on, name="nep-kept", daemon=True).start()


def keep_in(file: Path) -> None:
    """Say in which file a program keeps its variables; beside the program where nobody says."""
    _place[:] = [file]


@atexit.register
def keep_now() -> None:
    """Write what has changed."""
    for keeper in _keepers:
        keeper.write()


def take_troubles() -> list[Fault]:
    """What went wrong since this was asked last."""
    found, _troubles[:] = list(_troubles), []
    return found


def _beside_the_program() -> Path:
    program = getattr(sys.modules.get("__main__"), "__file__", None)
    return Path(program).with_suffix(SUFFIX) if program else Path.cwd() / f"program{SUFFIX}"


class _Keeper:
    """Keeps the values of ``held`` in a file; what else is in it stays there."""

    def __init__(self, file: Path, held: dict[str, object]) -> None:
        self._file, self._held = file, held
        self._others: dict[str, str] = {}
        self._written = ""
        self._lock = threading.Lock()
        self._is_told = False

    def read(self) -> None:
        """Take what was kept; a file that cannot be read is put aside."""
        try:
            if self._file.stat().st_size > MOST_BYTES:
                raise ValueError("too large")
            found = json.loads(self._file.read_bytes())
            if not isinstance(found, dict):
                raise ValueError("not the values of variables")
            kept = {name: _from_json(found[name]) for name in self._held.keys() & found.keys()}
        except FileNotFoundError:
            found, kept = {}, {}
        except (OSError, ValueError, TypeError, ValueRefused, RecursionError) as error:
            log.warning("%s cannot be read: %s", self._file, error)
            self._put_aside()
            found, kept = {}, {}
        self._others = {name: _text(value) for name, value in found.items()}
        self._held.update(kept)
        self._written = self._now()

    def write(self) -> None:
        """Write the file where something has changed; what cannot be written is told once."""
        with self._lock:
            now = self._now()
            if now == self._written:
                return
            try:
                write_whole(self._file, now)
            except OSError as error:
                log.warning("%s cannot be written: %s", self._file, error)
                self._tell_once()
            else:
                self._written = now

    def keep_on(self) -> None:
        """Look again and again, in a thread of its own, which ends with the program."""
        while True:
            time.sleep(LOOK_S)
            self.write()

    def _now(self) -> str:
        """The text of the file as it should be; a value that no file can hold stays as it was."""
        for name in list(self._held):
            try:
                self._others[name] = _text(_as_json(self._held[name]))
            except (TypeError, ValueError, RecursionError, RuntimeError):
                continue  # no plain value, or it was changed meanwhile
        lines = [f"{_text(name)}: {value}" for name, value in sorted(self._others.items())]
        return "{\n" + ",\n".join(lines) + "\n}\n"

    def _put_aside(self) -> None:
        aside = self._file.with_name(self._file.name + DAMAGED)
        try:
            self._file.replace(aside)
        except OSError as error:
            log.warning("%s cannot be put aside: %s", self._file, error)
        _troubles.append(
            fault_of(
                "What was kept in {file} cannot be read: it begins anew.",
                code="kept_damaged",
                checklist=("What was there is beside it now: {aside}.",),
                file=self._file.name,
                aside=aside.name,
            )
        )

    def _tell_once(self) -> None:
        if not self._is_told:
            self._is_told = True
            _troubles.append(
                fault_of(
                    "{file} cannot be written: what changes now is not kept.",
                    code="kept_not_written",
                    checklist=(
                        "Is there space on the disk, and may this program write there?",
                        "Save the project in another folder.",
                    ),
                    file=str(self._file),
                )
            )


def _as_json(value: object) -> object:
    """A value as JSON has it; what it has not is left to who writes it."""
    if isinstance(value, list):
        return [_as_json(item) for item in value]
    if not isinstance(value, dict):
        return value
    keys, values = names_in(value), [_as_json(one) for one in list(value.values())]
    if all(isinstance(key, str) for key in keys) and keys != [ENTRIES]:
        return dict(zip(keys, values, strict=True))
    return {ENTRIES: [list(entry) for entry in zip(keys, values, strict=True)]}


def _from_json(found: object) -> object:
    """The value in a file; raises ValueError, TypeError or ValueRefused for what is none."""
    if isinstance(found, list):
        return [_from_json(item) for item in found]
    if not isinstance(found, dict):
        return found
    if list(found) != [ENTRIES]:
        return {key: _from_json(value) for key, value in found.items()}
    entries = [(key, _from_json(value)) for key, value in found[ENTRIES]]
    return table_of(*(one for entry in entries for one in entry))


def _text(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)
