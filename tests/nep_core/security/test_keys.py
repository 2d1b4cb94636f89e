"""The key file: private, checked, written in one step, read again when it has changed."""

import os
import stat
from pathlib import Path

import msgspec
import pytest
import zmq
from hypothesis import given
from hypothesis import strategies as st

from nep_core.errors import KeyFileError
from nep_core.networks.security import keys as keys_module
from nep_core.networks.security.keys import KeyFile, Keys, new_keys, write_keys


def test_a_new_key_file_is_readable_by_its_owner_only(key_file: KeyFile) -> None:
    mode = stat.S_IMODE(key_file.path.stat().st_mode)

    assert mode == 0o600
    assert [path.name for path in key_file.path.parent.iterdir()] == ["owner.keys"]


@pytest.mark.parametrize("mode", [0o644, 0o640, 0o602])
def test_a_key_file_that_others_can_open_is_refused_with_what_to_do(
    key_file: KeyFile, mode: int
) -> None:
    key_file.path.chmod(mode)

    with pytest.raises(KeyFileError) as refused:
        KeyFile(key_file.path)

    assert "Other users of this computer can open it." in str(refused.value.sentence)
    assert f"chmod 600 {key_file.path}" in str(refused.value.checklist[0])


def test_a_key_file_of_another_user_is_refused(
    key_file: KeyFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    owner = key_file.path.stat().st_uid
    monkeypatch.setattr(os, "geteuid", lambda: owner + 1)
    if owner == 0:
        os.chown(key_file.path, 4711, -1)  # root's files are trusted, other users' are not

    with pytest.raises(KeyFileError, match="It belongs to another user"):
        KeyFile(key_file.path)


def test_on_windows_it_must_be_in_the_users_own_folder(
    key_file: KeyFile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(keys_module, "ON_WINDOWS", True)
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    KeyFile(key_file.path)
    monkeypatch.setattr(Path, "home", lambda: tmp_path / "me")

    with pytest.raises(KeyFileError, match="It is not in your own folder"):
        KeyFile(key_file.path)


def test_a_file_that_is_not_there_says_how_to_get_one(tmp_path: Path) -> None:
    with pytest.raises(KeyFileError, match="cannot be read: no such file") as missing:
        KeyFile(tmp_path / "no.keys")

    assert any("nep pair" in step for step in map(str, missing.value.checklist))


@given(st.binary(max_size=300))
def test_any_bytes_are_refused_with_a_sentence(
    tmp_path_factory: pytest.TempPathFactory, data: bytes
) -> None:
    path = tmp_path_factory.getbasetemp() / "any.keys"
    path.write_bytes(data)
    path.chmod(0o600)

    with pytest.raises(KeyFileError, match="is no key file, or it is damaged"):
        KeyFile(path)


@pytest.mark.parametrize(
    "change",
    [
        {"nep_keys": 2},
        {"public": "too short"},
        {"secret": zmq.curve_keypair()[1].decode()},
        {"title": ""},
        {"computers": [{"name": "x", "key": "no key"}]},
        {"master": 7},
    ],
)
def test_a_damaged_value_is_found(key_file: KeyFile, change: dict[str, object]) -> None:
    told = msgspec.json.decode(key_file.path.read_bytes()) | change
    key_file.path.write_bytes(msgspec.json.encode(told))

    with pytest.raises(KeyFileError, match="damaged"):
        KeyFile(key_file.path)


def test_a_program_that_runs_sees_who_was_let_in_and_who_was_forgotten(key_file: KeyFile) -> None:
    running = KeyFile(key_file.path)
    other = new_keys("other").public

    laptop = key_file.let_in("laptop", other, "192.168.1.7")
    let_in = running.keys.computers
    key_file.forget("laptop")

    assert let_in == (laptop,)
    assert running.keys.computers == ()


def test_a_program_that_runs_keeps_what_it_knew_while_the_file_is_damaged(
    key_file: KeyFile,
) -> None:
    running = KeyFile(key_file.path)
    before = running.keys

    key_file.path.write_bytes(b"{")

    assert running.keys == before


def test_computers_of_one_name_are_told_apart_and_one_that_comes_again_keeps_its_name(
    key_file: KeyFile,
) -> None:
    first, second = new_keys("a").public, new_keys("b").public

    names = [key_file.let_in("lab", key, "").name for key in (first, second, first)]

    assert names == ["lab", "lab 2", "lab"]
    assert len(key_file.keys.computers) == 2


def test_writing_that_fails_leaves_the_file_as_it_was(
    key_file: KeyFile, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = key_file.path.read_bytes()

    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)

    with pytest.raises(KeyFileError, match="cannot be written: no space left"):
        write_keys(key_file.path, new_keys("other"))
    assert key_file.path.read_bytes() == before
    assert len(list(key_file.path.parent.iterdir())) == 1


def test_only_the_computer_that_opened_the_network_is_its_owner(key_file: KeyFile) -> None:
    owner = key_file.keys
    guest = Keys(
        network=owner.network,
        title=owner.title,
        computer="laptop",
        public=new_keys("x").public,
        secret=owner.secret,
        master_key=owner.public,
    )

    assert owner.is_owner
    assert not guest.is_owner
    assert guest.allowed == {owner.public, guest.public}
