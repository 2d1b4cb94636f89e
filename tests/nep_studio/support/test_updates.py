"""The newest version is asked for only if a person wants that, once a day, and quietly."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from nep_studio import __version__
from nep_studio.settings import Settings
from nep_studio.support import updates
from nep_studio.support.updates import DAY_S, Newest, UpdateChoice, ask, newest_in, numbers


@dataclass
class Site:
    """A server on loopback that tells a version, and remembers what it was asked."""

    address: str = ""
    answer: bytes = b'{"version": "99.1", "page": "https://example.org/get"}'
    status: int = 200
    sent_on: str = ""
    asked: list[dict[str, str]] = field(default_factory=list)


@pytest.fixture
def site(monkeypatch: pytest.MonkeyPatch) -> Iterator[Site]:
    told = Site()
    for name in ("http_proxy", "HTTP_PROXY", "all_proxy", "ALL_PROXY"):
        monkeypatch.delenv(name, raising=False)

    class Pages(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            told.asked.append({"path": self.path, **self.headers})
            self.send_response(told.status)
            if told.sent_on:
                self.send_header("Location", told.sent_on)
            self.end_headers()
            self.wfile.write(told.answer)

        def log_message(self, *_: object) -> None:
            """Say nothing in tests."""

    with ThreadingHTTPServer(("127.0.0.1", 0), Pages) as server:
        told.address = f"http://127.0.0.1:{server.server_port}/newest.json"
        thread = threading.Thread(target=server.serve_forever, args=(0.01,))
        thread.start()
        yield told
        server.shutdown()
        thread.join()


def test_the_newest_version_is_told_and_only_the_own_one_is_sent(site: Site) -> None:
    newest = ask(site.address)

    assert newest == Newest("99.1", "https://example.org/get")
    assert newest.is_newer
    [asked] = site.asked
    assert asked.pop("Host").startswith("127.0.0.1")
    assert asked == {
        "path": "/newest.json",
        "User-Agent": f"NEP-Studio/{__version__}",
        "Accept-Encoding": "identity",
        "Connection": "close",
    }


@pytest.mark.parametrize("status", [404, 500])
def test_a_site_that_fails_tells_nothing(site: Site, status: int) -> None:
    site.status = status

    assert ask(site.address) is None


def test_it_is_sent_on_only_to_a_page_that_is_as_safe(site: Site) -> None:
    """Nothing may be asked there before that is known."""
    import urllib.error

    opener, usual = updates._opener("https"), updates._opener("http")
    site.status, site.sent_on = 302, site.address

    with pytest.raises(ValueError, match="less safe"):
        opener.open(site.address, timeout=2)
    with pytest.raises(urllib.error.HTTPError, match="infinite loop"):
        usual.open(site.address, timeout=2)
    site.sent_on = "ftp://127.0.0.1/newest"

    assert ask(site.address) is None


def test_a_silent_or_missing_site_is_given_up_soon(
    monkeypatch: pytest.MonkeyPatch, free_port: int
) -> None:
    monkeypatch.setattr(updates, "TIMEOUT_S", 0.1)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()

        assert ask(f"http://127.0.0.1:{silent.getsockname()[1]}/") is None

    assert ask(f"http://127.0.0.1:{free_port}/") is None


@pytest.mark.parametrize("address", ["", "file:///etc/passwd", "ftp://x/y", "http://", "http://[x"])
def test_only_pages_of_the_web_are_asked(address: str) -> None:
    assert ask(address) is None


@pytest.mark.parametrize(
    "answer",
    [
        *(b"", b"<html>", b"{", b"[]", b"{}", b'{"version": []}', b'{"version": "1.0; rm"}'),
        *(b"1" * 20_000, b"\xff\xfe", b'{"version": "9999999999999"}', b"[" * 9_000),
    ],
)
def test_an_answer_that_makes_no_sense_tells_nothing(answer: bytes) -> None:
    assert newest_in(answer) is None


def test_a_page_that_is_none_of_the_web_is_left_out() -> None:
    assert newest_in(b'{"version": "2.0", "page": "file:///etc"}') == Newest("2.0")
    assert newest_in(b"v2.0.1\n") == Newest("2.0.1")


def test_versions_are_compared_by_their_numbers() -> None:
    assert numbers("1.10") > numbers("1.9.5") > numbers("v1.9")
    assert numbers("1.2.0") == numbers("1.2")
    assert not Newest(__version__).is_newer


def test_nothing_is_asked_until_a_person_wants_it_and_gives_an_address(tmp_path: Path) -> None:
    choice = UpdateChoice(Settings(tmp_path))
    at_first = choice.is_wanted, choice.address, choice.is_due(1e9)
    choice.is_wanted = True
    without_address = choice.is_due(1e9)
    choice.address = "http://127.0.0.1/"

    assert at_first == (False, "", False)
    assert not without_address
    assert choice.is_due(1e9)


def test_it_is_asked_once_a_day_also_when_the_clock_goes_back(tmp_path: Path) -> None:
    choice = UpdateChoice(Settings(tmp_path))
    choice.is_wanted, choice.address = True, "http://127.0.0.1/"
    choice.note_asked(1e9)

    again = UpdateChoice(Settings(tmp_path))

    assert not again.is_due(1e9 + DAY_S - 1)
    assert again.is_due(1e9 + DAY_S)
    assert again.is_due(1e9 - 10)


def test_settings_that_make_no_sense_ask_nobody_and_do_not_stop_anything(tmp_path: Path) -> None:
    text = "[updates]\ncheck=yes\naddress=file:///x\nasked=never\n"
    (tmp_path / "settings.ini").write_text(text, encoding="utf-8")
    choice = UpdateChoice(Settings(tmp_path))

    assert (choice.address, choice.is_due(1e9)) == ("", False)
