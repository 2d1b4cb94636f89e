from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from robots.errors import WrongAddress
from robots.naoqi.discovery import (
    FOLDER_VARIABLE,
    PASSWORD_VARIABLE,
    Address,
    SavedLogin,
    logins_file,
    plain_address,
    read_address,
    save_login,
    saved_login,
)


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    monkeypatch.delenv(PASSWORD_VARIABLE, raising=False)
    return tmp_path


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("192.168.1.10", ("192.168.1.10", 9559)),
        (" nao.local ", ("nao.local", 9559)),
        ("127.0.0.1:9600", ("127.0.0.1", 9600)),
    ],
)
def test_an_address_may_name_a_port(text: str, address: Address) -> None:
    assert read_address(text) == address


@pytest.mark.parametrize(
    "text", ["", " ", ":9559", "nao:", "nao:0", "nao:70000", "nao:x", "http://nao", "my nao", "a:²"]
)
def test_text_that_is_no_address_is_refused_with_what_to_do(text: str) -> None:
    with pytest.raises(WrongAddress, match="is not the address of a robot") as told:
        read_address(text)

    assert "chest button" in str(told.value.checklist[0])


def test_the_usual_port_is_left_out_when_an_address_is_told() -> None:
    assert plain_address(("nao.local", 9559)) == "nao.local"
    assert plain_address(("nao.local", 9503)) == "nao.local:9503"


def test_a_login_is_kept_for_its_address_until_it_is_forgotten() -> None:
    login = SavedLogin("nao", "secret", "AA:BB")

    save_login("10.0.0.7", login)
    save_login("10.0.0.8", SavedLogin("other", "word"))
    kept = saved_login("10.0.0.7")
    save_login("10.0.0.7", None)

    assert kept == login
    assert saved_login("10.0.0.7") is None
    assert saved_login("10.0.0.8") == SavedLogin("other", "word")


@pytest.mark.skipif(os.name == "nt", reason="Windows keeps the user's folder for the user")
def test_nobody_else_may_read_the_file_of_passwords() -> None:
    save_login("10.0.0.7", SavedLogin("nao", "secret"))

    assert stat.S_IMODE(logins_file().stat().st_mode) == 0o600


def test_a_file_of_passwords_that_cannot_be_read_is_like_none(folder: Path) -> None:
    logins_file().write_bytes(b'{"10.0.0.7": 3')

    before = saved_login("10.0.0.7")
    save_login("10.0.0.7", SavedLogin("nao", "new"))

    assert before is None
    assert saved_login("10.0.0.7") == SavedLogin("nao", "new")


def test_a_password_in_the_environment_goes_before_the_file(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    save_login("10.0.0.7", SavedLogin("nao", "kept"))

    monkeypatch.setenv(PASSWORD_VARIABLE, "from outside")

    assert saved_login("10.0.0.7") == SavedLogin("nao", "from outside")
