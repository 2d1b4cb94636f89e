"""Opening a network as a program does it, finding it, and the commands around it."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_core.cli import main
from nep_core.cli.pair import _address_and_code, _door_at
from nep_core.errors import KeyFileError, NetworkError, PairingError
from nep_core.networks import discovery
from nep_core.networks.discovery import Announcement, Found, announce, find
from nep_core.networks.master import Master
from nep_core.networks.security import addresses
from nep_core.networks.security.keys import KeyFile, new_keys
from nep_core.networks.security.opening import Opening
from nep_core.networks.security.pairing import DoorEvent, pair

HOST = "127.0.0.1"


@pytest.fixture
def opening(tmp_path: Path, free_port: int) -> Iterator[Opening]:
    events: list[DoorEvent] = []
    made = Opening(
        tmp_path / "project.keys",
        title="karate",
        host=HOST,
        port=free_port,
        door_port=0,
        is_announced=False,
        on_event=events.append,
    )
    made.start()
    yield made
    made.close()


def test_an_opening_pairs_shows_and_forgets_computers(opening: Opening, tmp_path: Path) -> None:
    keys = pair(HOST, opening.door_port, opening.new_code().text, tmp_path / "guest.keys")

    peers = opening.file.keys.computers
    was_there = opening.file.forget(peers[0].name)

    assert keys.title == "karate"
    assert keys.master == opening.master
    assert [peer.key for peer in peers] == [keys.public]
    assert was_there
    assert opening.file.keys.computers == ()
    assert not opening.file.forget("nobody")


def test_a_network_that_is_opened_again_keeps_its_keys_and_computers(
    opening: Opening, tmp_path: Path, free_port: int
) -> None:
    pair(HOST, opening.door_port, opening.new_code().text, tmp_path / "guest.keys")
    before = opening.file.keys
    opening.close()

    again = Opening(opening.file.path, host="127.0.0.2", port=free_port, is_announced=False)
    again.start()
    again.close()

    assert again.file.keys.computers == before.computers
    assert again.file.keys.secret == before.secret
    assert again.file.keys.master == f"tcp://127.0.0.2:{free_port}"


def test_only_the_owner_opens_a_network(opening: Opening, tmp_path: Path) -> None:
    pair(HOST, opening.door_port, opening.new_code().text, tmp_path / "guest.keys")

    with pytest.raises(KeyFileError, match="which another computer opened"):
        Opening(tmp_path / "guest.keys", host=HOST)


def test_a_port_that_cannot_be_is_told(tmp_path: Path) -> None:
    for ports in ({"port": 99999}, {"door_port": 99999}):
        with pytest.raises(NetworkError, match="is not an endpoint"):
            Opening(tmp_path / "new.keys", host="127.0.0.1", **ports)

    assert not list(tmp_path.iterdir())


def test_a_network_that_is_announced_is_found() -> None:
    told = Found("Ünïcode karate", "lab", "a" * 32, f"tcp://{HOST}:7123", 7124)
    announcement = announce(told)

    found = find(10.0, is_enough=lambda seen: told in seen, interfaces=[HOST])
    announcement.close()

    assert announcement.zeroconf is not None
    assert told in found


def test_announcing_and_finding_fail_quietly_where_they_cannot_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    announcement = announce(Found("x", "x", "x", "tcp://198.51.100.1:7100", 7101))
    announcement.close()

    assert announcement.zeroconf is None
    assert find(0.1, interfaces=["198.51.100.1"]) == []


@pytest.mark.parametrize(
    "properties", [{}, {"network": b"\xff"}, {"network": "x", "title": "x", "computer": "x"}]
)
def test_an_announcement_that_cannot_be_read_is_left_out(properties: dict[str, object]) -> None:
    from zeroconf import ServiceInfo

    told = ServiceInfo(
        discovery.SERVICE,
        f"x.{discovery.SERVICE}",
        parsed_addresses=[HOST],
        port=1,
        properties=properties,
    )

    assert discovery._found_of(told) is None


def test_an_announcement_of_nothing_is_closed_too() -> None:
    Announcement(None).close()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["482", "913"], ("", "482913")),
        (["482 913"], ("", "482913")),
        (["192.168.1.5", "482913"], ("192.168.1.5", "482913")),
    ],
)
def test_a_code_is_read_as_people_type_it(words: list[str], told: tuple[str, str]) -> None:
    assert _address_and_code(words) == told


@pytest.mark.parametrize("words", [["1"], ["a", "b", "482913"], ["192.168.1.5"], [""]])
def test_what_is_no_code_is_told(words: list[str]) -> None:
    with pytest.raises(PairingError, match="is no code"):
        _address_and_code(words)


@pytest.mark.parametrize(
    ("address", "told"),
    [
        ("lab", ("lab", 7101)),
        ("tcp://10.0.0.1:99", ("10.0.0.1", 99)),
        ("fe80::1", ("fe80::1", 7101)),
        ("[fe80::1]:99", ("fe80::1", 99)),
    ],
)
def test_a_door_is_found_by_address_with_or_without_its_port(
    address: str, told: tuple[str, int]
) -> None:
    assert _door_at(address) == told


def test_the_computers_of_a_network_are_listed_and_forgotten_by_command(
    key_file: KeyFile, capsys: pytest.CaptureFixture[str]
) -> None:
    key_file.let_in("laptop", new_keys("x").public, "192.168.1.7")

    assert main(["computers", "--keys", str(key_file.path)]) == 0
    assert "laptop   192.168.1.7" in capsys.readouterr().out
    assert main(["computers", "--keys", str(key_file.path), "--forget", "laptop"]) == 0
    assert key_file.keys.computers == ()
    assert main(["computers", "--keys", str(key_file.path), "--forget", "laptop"]) == 1


def test_a_computer_in_no_network_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(addresses, "_way_to", lambda host: "")
    monkeypatch.setattr(addresses, "own_addresses", lambda: [])
    monkeypatch.delenv("NEP_HOST", raising=False)

    with pytest.raises(NetworkError, match="This computer is in no network"):
        addresses.own_address("tcp://198.51.100.1:7100")


def test_the_way_to_the_master_tells_the_own_address(monkeypatch: pytest.MonkeyPatch) -> None:
    ways = {"192.168.1.5": "192.168.1.7", "127.0.0.1": "127.0.0.1", addresses.NOWHERE: "10.1.1.1"}
    monkeypatch.setattr(addresses, "_way_to", ways.__getitem__)
    monkeypatch.delenv("NEP_HOST", raising=False)

    assert addresses.own_address("tcp://192.168.1.5:7100") == "192.168.1.7"
    assert addresses.own_address("tcp://127.0.0.1:7100") == "10.1.1.1"


def test_beside_a_master_that_runs_it_is_said_that_this_is_one_too(
    free_port: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture
) -> None:
    monkeypatch.setenv("NEP_KEYS", "")  # what the command sets is taken back with it
    plain = Master(f"tcp://127.0.0.1:{free_port}")
    keys = str(tmp_path / "own.keys")
    place = ["--host", "127.0.0.1", "--port", str(free_port), "--door", str(free_port + 1)]

    code = main(["open", "--keys", keys, "--no-announce", *place])
    plain.close()

    assert code == 1
    assert "nep open is a master itself" in capsys.readouterr().err
