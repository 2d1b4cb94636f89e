"""Three computers: one opens its network, one is paired with it, one is refused."""

import re
import subprocess
import threading
from pathlib import Path

import pytest

from nep_core.networks.security.keys import KeyFile, Keys
from tests.nep_core.security.conftest import keys_of_a_guest, written
from tests.nep_core.security.hosts import Host, are_apart, three_hosts

pytestmark = pytest.mark.long

PROGRAMS = "tests.nep_core.security.host_programs"
ALONE = {"NEP_MASTER": "", "NEP_KEYS": "", "NEP_HOST": "", "NEP_ORIGINAL": "0"}


def line_with(process: subprocess.Popen[str], wanted: str, seconds: float = 20.0) -> str:
    """The next line that matches; what was said instead when it does not come."""
    said: list[str] = []
    timer = threading.Timer(seconds, process.kill)
    timer.start()
    assert process.stdout is not None
    for line in process.stdout:
        said.append(line)
        if re.search(wanted, line):
            timer.cancel()
            return line
    timer.cancel()
    pytest.fail(f"{wanted!r} was not said, but: {''.join(said)}")


def test_a_paired_computer_takes_part_and_another_is_refused_visibly(tmp_path: Path) -> None:
    with three_hosts() as hosts:
        home, laptop, stranger = hosts

        opened = nep(home, "open", "--keys", f"{tmp_path}/home.keys", "--host", home.address)
        code = line_with(opened, r"nep pair \d{3} \d{3}").split("pair ")[1].strip()
        found = (home.address,) if not are_apart(hosts) else ()  # else by zeroconf
        paired = nep(laptop, "pair", *found, code, "--keys", f"{tmp_path}/laptop.keys")
        line_with(paired, "Paired with")

        witness = run(home, "witness", tmp_path / "home.keys")
        line_with(witness, "ready")
        run(laptop, "watch", tmp_path / "laptop.keys")
        line_with(witness, r'{"count": \d+}')

        plain = nep(stranger, "topics", master=f"tcp://{home.address}:7100")
        forgotten = written(tmp_path / "stranger.keys", _keys_of_nobody(tmp_path))
        refused = nep(stranger, "topics", keys=forgotten.path)
        line_with(plain, "open only to programs that have its keys")
        line_with(refused, "does not take the keys")
        where = f"at {stranger.address}" if are_apart(hosts) else "of this computer"
        line_with(witness, f"^master: .*A program {where} showed no key")

    seen = laptop.address if are_apart(hosts) else "127.0.0.1"
    assert [one.address for one in KeyFile(tmp_path / "home.keys").keys.computers] == [seen]


def _keys_of_nobody(folder: Path) -> Keys:
    """Keys of a computer that knows the network, but was not let in."""
    return keys_of_a_guest(KeyFile(folder / "home.keys").keys, "stranger")


def nep(
    host: Host, *arguments: str, master: str = "", keys: Path | str = ""
) -> subprocess.Popen[str]:
    environment = ALONE | {"NEP_MASTER": master, "NEP_KEYS": str(keys)}
    return host.start(*arguments, module=PROGRAMS, environment=environment)


def run(host: Host, program: str, keys: Path) -> subprocess.Popen[str]:
    return nep(host, program, keys=keys)
