"""Pairing: a second computer gets in by the code, once, in time, and by nothing else."""

import json
import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import msgspec
import pytest

from faults import Text
from nep_core.errors import KeyFileError, PairingError, PortTaken
from nep_core.networks.security import pairing
from nep_core.networks.security import pairing as door_module
from nep_core.networks.security.keys import KeyFile, Keys, new_keys
from nep_core.networks.security.pairing import Door, DoorEvent, pair
from tests.nep_core.security.conftest import wait_until, written

HOST = "127.0.0.1"
CLEAR = b'{"do":"no","sentence":"\\u001b[2J","checklist":["\\u001b"]}\n'
"""It would clear the terminal."""


@pytest.fixture
def events() -> list[DoorEvent]:
    return []


@pytest.fixture
def door(key_file: KeyFile, events: list[DoorEvent]) -> Iterator[Door]:
    key_file.change(_with_master)
    opened = Door(key_file, (HOST, 0), events.append)
    yield opened
    opened.close()


def _with_master(keys: Keys) -> Keys:
    return msgspec.structs.replace(keys, master="tcp://127.0.0.1:7100")


def _wrong(code: str) -> str:
    return f"{(int(code.replace(' ', '')) + 1) % 1_000_000:06d}"


def test_the_right_code_lets_a_computer_in_and_gives_it_a_key_file(
    door: Door, key_file: KeyFile, tmp_path: Path, events: list[DoorEvent]
) -> None:
    keys = pair(HOST, door.port, door.new_code().text, tmp_path / "guest.keys")

    owner = key_file.keys
    assert keys.master == "tcp://127.0.0.1:7100"
    assert (keys.network, keys.master_key) == (owner.network, owner.public)
    assert [one.key for one in owner.computers] == [keys.public]
    assert KeyFile(tmp_path / "guest.keys").keys == keys
    assert not keys.is_owner
    assert [event.kind for event in events] == ["paired"]
    assert events[0].address == HOST


def test_a_code_is_for_one_computer_only(door: Door, tmp_path: Path) -> None:
    code = door.new_code().text
    pair(HOST, door.port, code, tmp_path / "first.keys")

    with pytest.raises(PairingError, match="There is no code now"):
        pair(HOST, door.port, code, tmp_path / "second.keys")

    assert not (tmp_path / "second.keys").exists()


def test_a_code_that_is_too_old_lets_nobody_in(door: Door, tmp_path: Path) -> None:
    code = door.new_code(seconds=0.0).text

    with pytest.raises(PairingError, match="too old"):
        pair(HOST, door.port, code, tmp_path / "late.keys")

    assert door.code is None


def test_three_wrong_tries_end_a_code(
    door: Door, key_file: KeyFile, tmp_path: Path, events: list[DoorEvent]
) -> None:
    code = door.new_code().text

    for _ in range(3):
        with pytest.raises(PairingError, match="That is not the code"):
            pair(HOST, door.port, _wrong(code), tmp_path / "guest.keys")
    with pytest.raises(PairingError, match="There is no code now"):
        pair(HOST, door.port, code, tmp_path / "guest.keys")

    assert [event.kind for event in events] == ["wrong_code", "wrong_code", "code_used_up"]
    assert key_file.keys.computers == ()


def test_who_breaks_off_after_the_doors_answer_has_had_a_try(door: Door) -> None:
    code = door.new_code()
    hello = pairing.encode(pairing.GuestTalk("000000", _guest()).hello())

    for _ in range(code.tries_left):
        with socket.create_connection((HOST, door.port)) as connection:
            connection.sendall(hello + b"\n")
            assert b"offer" in connection.recv(4096)

    assert wait_until(lambda: door.code is None)


def test_a_new_code_ends_the_one_before(door: Door, tmp_path: Path) -> None:
    old, new = door.new_code().text, door.new_code().text

    with pytest.raises(PairingError):
        pair(HOST, door.port, old, tmp_path / "guest.keys")

    assert pair(HOST, door.port, new, tmp_path / "guest.keys")


def test_a_computer_that_is_paired_again_keeps_its_key(
    door: Door, key_file: KeyFile, tmp_path: Path
) -> None:
    first = pair(HOST, door.port, door.new_code().text, tmp_path / "guest.keys")
    again = pair(HOST, door.port, door.new_code().text, tmp_path / "guest.keys")

    assert again.public == first.public
    assert len(key_file.keys.computers) == 1


def test_the_key_file_of_another_network_is_not_overwritten(door: Door, tmp_path: Path) -> None:
    other = written(tmp_path / "other.keys", new_keys("other"))
    before = other.path.read_bytes()

    with pytest.raises(KeyFileError, match='belongs to another network, "other"'):
        pair(HOST, door.port, door.new_code().text, other.path)

    assert other.path.read_bytes() == before


def test_who_sits_between_and_does_not_know_the_code_gets_neither_in(
    door: Door, key_file: KeyFile, tmp_path: Path
) -> None:
    """It answers the guest as a door, by a code of its own, and passes the proof on."""
    code = door.new_code().text
    listener = socket.create_server((HOST, 0))

    def sit_between() -> None:
        connection, _ = listener.accept()
        with connection:
            talk = pairing.DoorTalk(_wrong(code))
            hello = pairing.decode(connection.recv(4096))
            connection.sendall(pairing.encode(talk.offer(hello)) + b"\n")
            proof = pairing.decode(connection.recv(4096))
            fake = pairing.Host(
                network="x", title="x", computer="x", key=_guest().key, master="tcp://1.2.3.4:7"
            )
            connection.sendall(pairing.encode(talk.welcome(proof, fake)) + b"\n")

    thread = threading.Thread(target=sit_between)
    thread.start()

    with pytest.raises(PairingError, match="That is not the code"):
        pair(HOST, listener.getsockname()[1], code, tmp_path / "guest.keys")
    thread.join()
    listener.close()

    assert not (tmp_path / "guest.keys").exists()
    assert key_file.keys.computers == ()


RUBBISH = [
    b"",
    b"\n",
    b"GET / HTTP/1.1\r\n\r\n",
    b"\x00\xff" * 3000,
    b"{" * 5000 + b"\n",
    b'{"do":"pair","version":1}\n',
    b'{"do":"pair","version":99,"spake":""}\n',
    b'{"do":"pair","version":1,"spake":"zz"}\n',
    json.dumps({"do": "pair", "version": 1, "spake": "41" + "00" * 32}).encode() + b"\n",
    json.dumps({"do": "pair", "version": 1, "spake": "42" * 33}).encode() + b"\n",
    b'{"do":"welcome","told":"","mac":""}\n',
    b'{"do":"proof","told":"{}","mac":"\\u0000"}\n',
]


def test_no_bytes_let_anybody_in_or_shut_the_door(
    key_file: KeyFile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(door_module, "TALK_S", 0.2)
    door = Door(key_file, (HOST, 0))

    for data in RUBBISH:
        door.new_code()
        with socket.create_connection((HOST, door.port), timeout=5) as connection:
            connection.sendall(data)
            connection.shutdown(socket.SHUT_WR)
            while _received(connection):
                pass
    assert key_file.keys.computers == ()

    monkeypatch.setattr(door_module, "TALK_S", 5.0)
    key_file.change(_with_master)
    assert pair(HOST, door.port, door.new_code().text, tmp_path / "guest.keys")
    door.close()


def _received(connection: socket.socket) -> bytes:
    try:
        return connection.recv(4096)
    except ConnectionError:
        return b""


def test_somebody_who_says_nothing_is_sent_away_and_others_get_in(
    key_file: KeyFile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(door_module, "HELLO_S", 0.2)
    key_file.change(_with_master)
    door = Door(key_file, (HOST, 0))
    with socket.create_connection((HOST, door.port)) as silent:
        silent.sendall(b"{")
        began_s = time.monotonic()
        pair(HOST, door.port, door.new_code().text, tmp_path / "guest.keys")
        waited_s = time.monotonic() - began_s
    door.close()

    assert waited_s < 5.0


@pytest.mark.parametrize(
    "answer", [b"", b"rubbish\n", b"{}\n", b'{"do":"offer","spake":"42"}\n', CLEAR]
)
def test_what_answers_that_is_no_door_is_told(tmp_path: Path, answer: bytes) -> None:
    listener = socket.create_server((HOST, 0))

    def serve() -> None:
        connection, _ = listener.accept()
        with connection:
            connection.recv(4096)
            connection.sendall(answer)

    thread = threading.Thread(target=serve)
    thread.start()
    with pytest.raises(PairingError) as error:
        pair(HOST, listener.getsockname()[1], "123 456", tmp_path / "guest.keys")
    thread.join()
    listener.close()

    assert error.value.checklist
    assert str(error.value.sentence).isprintable()


def test_no_computer_at_the_address_is_told_with_what_to_look_at(
    tmp_path: Path, free_port: int
) -> None:
    with pytest.raises(PairingError, match="connection refused") as error:
        pair(HOST, free_port, "123 456", tmp_path / "guest.keys")

    assert any("firewall" in step for step in map(str, error.value.checklist))


@pytest.mark.parametrize(("host", "port"), [("a..b", 7101), ("x" * 64, 7101), (HOST, 99999)])
def test_a_place_that_cannot_be_is_told(tmp_path: Path, host: str, port: int) -> None:
    with pytest.raises(PairingError, match="No computer answers"):
        pair(host, port, "123 456", tmp_path / "guest.keys")


def test_both_sides_hear_when_the_door_cannot_keep_the_new_key(
    door: Door, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    code = door.new_code().text

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)

    with pytest.raises(PairingError, match="cannot keep your key") as told:
        pair(HOST, door.port, code, tmp_path / "guest.keys")
    assert "no space left" in caplog.text
    caplog.clear()
    assert told.value.fault.code == "key_not_kept"
    why = told.value.checklist[0]  # a template, so that the guest reads it in its language
    assert why.text == "The key file {path} cannot be written: {reason}."
    assert why.values["reason"] == Text("no space left on device")


CLEARS = {"text": "Not {a}.\x1b", "values": {"a": "\x1b[2J"}}


@pytest.mark.parametrize("fault", [None, {"code": "x", "sentence": CLEARS}])
def test_a_refusal_of_any_age_is_told_and_commands_no_terminal(fault: dict | None) -> None:
    refusal = pairing.No(sentence="Not [2J.\x1b", checklist=["Go\x07 on."], fault=fault)

    with pytest.raises(PairingError) as told:
        pairing._expect(pairing.Welcome, pairing.decode(pairing.encode(refusal)))

    assert str(told.value) == "Not [2J."


def test_a_taken_port_of_the_door_is_told(door: Door, key_file: KeyFile) -> None:
    with pytest.raises(PortTaken, match="where computers are paired, cannot be used"):
        Door(key_file, (HOST, door.port))


def _guest() -> pairing.Guest:
    return pairing.Guest(name="laptop", key=new_keys("x").public)
