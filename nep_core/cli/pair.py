"""``nep open``, ``pair``, ``find`` and ``computers``: a network of several computers."""

from __future__ import annotations

import argparse
import os
import sys
import threading
import time
from pathlib import Path

from nep_core.cli.services import serve
from nep_core.errors import PairingError, PortTaken
from nep_core.networks import discovery
from nep_core.networks.master import Master
from nep_core.networks.security import KEYS_VARIABLE, key_file_path
from nep_core.networks.security.keys import KeyFile
from nep_core.networks.security.opening import DOOR_PORT, MASTER_PORT, Opening
from nep_core.networks.security.pairing import DoorEvent, pair
from nep_core.places import key_file

SET = "set" if os.name == "nt" else "export"
CODE_DIGITS = 6


def add_arguments(name: str, parser: argparse.ArgumentParser) -> None:
    """Say which options the command has."""
    if name == "find":
        return
    parser.add_argument(
        "--keys",
        type=Path,
        metavar="FILE",
        help=f"the key file (default: {KEYS_VARIABLE}, else one in your own folder)",
    )
    if name == "open":
        parser.add_argument("--host", metavar="ADDRESS", help="this computer's address to use")
        parser.add_argument("--port", type=int, default=MASTER_PORT, help="of the master")
        parser.add_argument("--door", type=int, default=DOOR_PORT, help="the port for pairing")
        parser.add_argument("--title", default="NEP", help="what the network is called")
        parser.add_argument(
            "--announce",
            action=argparse.BooleanOptionalAction,
            default=True,
            help="let other computers find it by itself",
        )
    elif name == "pair":
        parser.add_argument(
            "words",
            nargs="+",
            metavar="[ADDRESS] CODE",
            help="the other computer's address, if it is not found by itself, and the code",
        )
    elif name == "computers":
        parser.add_argument("--forget", metavar="NAME", help="let this computer in no more")


def run(options: argparse.Namespace) -> int:
    """Do what was asked for."""
    commands = {"open": _open, "pair": _pair, "find": _find, "computers": _computers}
    return commands[options.command](options)


def _path(options: argparse.Namespace) -> Path:
    return (options.keys or key_file_path() or key_file()).absolute()


def _open(options: argparse.Namespace) -> int:
    path = _path(options)
    opening = Opening(
        path,
        title=options.title,
        host=options.host,
        port=options.port,
        door_port=options.door,
        is_announced=options.announce,
        on_event=_tell,
    )
    os.environ[KEYS_VARIABLE] = str(path)
    master = _master(opening)
    try:
        opening.start()
        return serve(master, lambda: _begin(opening, path))
    finally:
        opening.close()
        master.close()


def _master(opening: Opening) -> Master:
    try:
        return Master(opening.master, is_shared=True)
    except PortTaken as error:
        raise PortTaken(
            "The network cannot be opened at {master}: {sentence}",
            checklist=(
                "Is that nep master? Stop it first: nep open is a master itself.",
                "Is it NEP Studio? Choose there: Robots, Open to other computers.",
                "Or choose another port: nep open --port 7200.",
            ),
            master=opening.master,
            sentence=error.sentence,
        ) from error


def _begin(opening: Opening, path: Path) -> None:
    print(f'The network "{opening.file.keys.title}" is open at {opening.master}.')
    print(f"Programs of this computer take part with:  {SET} {KEYS_VARIABLE}={path}")
    _show_code(opening)
    threading.Thread(target=_on_enter, args=(opening,), daemon=True).start()


def _show_code(opening: Opening) -> None:
    code = opening.new_code()
    place = opening.host if opening.door_port == DOOR_PORT else opening.door_place
    print("\nOn the other computer, within two minutes:", flush=True)
    print(f"  nep pair {code.text}\nor, when that does not find this computer:", flush=True)
    print(f"  nep pair {place} {code.text}\nEnter makes a new code, Ctrl-C ends.", flush=True)


def _on_enter(opening: Opening) -> None:
    """A new code for each line; raw reads, since a buffered one aborts the interpreter's end."""
    try:
        while os.read(sys.stdin.fileno(), 1024):
            _show_code(opening)
    except (OSError, ValueError):
        return  # there is no standard input


def _tell(event: DoorEvent) -> None:
    hint = "" if event.kind == "wrong_code" else " Enter makes a new code."
    print(f"{event.sentence}{hint}", flush=True)


def _pair(options: argparse.Namespace) -> int:
    path = _path(options)
    address, code = _address_and_code(options.words)
    host, port = _door_at(address) if address else _found_door()
    keys = pair(host, port, code, path)
    print(f'Paired with {keys.computers[0].name}: the network "{keys.title}" at {keys.master}.')
    print(f"Programs of this computer take part with:  {SET} {KEYS_VARIABLE}={path}")
    return 0


def _address_and_code(words: list[str]) -> tuple[str, str]:
    """The two parts of "192.168.1.5 482 913": the code may be written in two halves."""
    parts = " ".join(words).split()
    code = "".join(part for part in parts if part.isdigit())
    others = [part for part in parts if not part.isdigit()]
    if len(code) != CODE_DIGITS or len(others) > 1:
        raise PairingError(
            '"{words}" is no code.',
            checklist=(
                "A code has six digits; the other computer shows it: nep open.",
                "Write the address before it, as in: nep pair 192.168.1.5 482 913",
            ),
            words=" ".join(words),
        )
    return "".join(others), code


def _door_at(address: str) -> tuple[str, int]:
    """An address, with or without the door's port."""
    address = address.removeprefix("tcp://")
    host, colon, port = address.rpartition(":")
    if colon and port.isdigit() and (address.count(":") == 1 or host.endswith("]")):
        return host.strip("[]"), int(port)
    return address.strip("[]"), DOOR_PORT


def _found_door() -> tuple[str, int]:
    print("Looking for an open network ...", flush=True)
    found = discovery.find(is_enough=bool)
    if len({(one.host, one.door_port) for one in found}) == 1:
        return found[0].host, found[0].door_port
    what = "Several open networks were found" if found else "No open network was found"
    lines = tuple(f"{one.title} on {one.computer}: nep pair {one.host} CODE" for one in found)
    raise PairingError(
        "{what}.",
        checklist=(
            *lines,
            "Write the address that the other computer shows: nep pair ADDRESS CODE.",
            "Many guest and school networks hide computers from each other: then only a network "
            "of your own helps, such as a phone's hot spot.",
        ),
        what=what,
    )


def _find(_options: argparse.Namespace) -> int:
    found = discovery.find()
    for one in found:
        print(f"{one.title}   on {one.computer}   {one.master}   pair at {one.host}")
    if not found:
        print("No open network was found. One that was opened by address works without this.")
    return 0


def _computers(options: argparse.Namespace) -> int:
    file = KeyFile(_path(options))
    if options.forget:
        if not file.forget(options.forget):
            print(f"No computer of this name: {options.forget}.", file=sys.stderr)
            return 1
        print(
            f"{options.forget} is let in no more. Connections that exist end when the programs "
            "here are started again."
        )
        return 0
    keys = file.keys
    print(f'The network "{keys.title}" at {keys.master or "no address yet"}')
    for one in keys.computers:
        since = time.strftime("%Y-%m-%d %H:%M", time.localtime(one.since))
        print(f"{one.name}   {one.address}   since {since}")
    return 0
