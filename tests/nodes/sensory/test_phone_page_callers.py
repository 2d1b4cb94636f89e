"""Who the phone page follows, and what it does with callers who want too much."""

import asyncio
import contextlib
import json
import socket
import time

import aiohttp
import pytest

from nep_core.errors import PortTaken
from nodes.sensory.connectors.connector import Settings
from nodes.sensory.phone_page import server, site
from nodes.sensory.phone_page.server import PhonePage
from tests.nodes.sensory.page_client import (
    TOKEN,
    ask,
    asking,
    batch,
    post,
    posting,
    saying,
    talk,
)
from tests.nodes.sensory.page_serving import client, folder, own_page, page, shared_page

__all__ = ["client", "folder", "own_page", "page", "shared_page"]


def test_a_phone_is_followed_by_websocket(page):
    answers, _ = talk(page, saying(batch(1.0, 2.0)))

    arrived = page.readings()
    assert answers == ["followed"]
    assert [len(one.readings) for one in arrived] == [2]


def test_a_second_phone_is_told_to_wait_and_so_is_the_user(page):
    def second(line):
        return posting(page, batch(1.0, phone="b2"))

    answers, _ = talk(page, saying(batch(1.0)), second)
    status, _, answer = post(page, batch(2.0, phone="b2"))

    first, warning, next_one = page.readings()
    assert json.loads(answers[1][2]) == {"state": "busy"}
    assert str(warning.trouble).startswith("A second phone (127.0.0.1) has the page open")
    assert len(first.readings) == len(next_one.readings) == 1
    assert (status, json.loads(answer)["state"]) == (200, "followed")  # as the first one left


def test_a_websocket_that_sends_rubbish_is_closed(page):
    for rubbish in ("rubbish", batch(1.0, gyr=[])):
        answers, code = talk(page, saying(rubbish))

        assert answers == [None]
        assert code == 1007


def test_a_flood_is_closed_and_little_of_it_arrives(own_page):
    async def flood(line):
        with contextlib.suppress(ConnectionError, aiohttp.ClientError):
            for _ in range(1000):
                await line.send_str(batch(*range(200)))
        while (await line.receive(timeout=3)).type is aiohttp.WSMsgType.TEXT:
            pass

    _, code = talk(own_page, flood)

    assert code in (1008, 1006)  # it may still have been sending when the line was closed
    arrived = own_page.readings()
    assert len(arrived) < 256
    assert sum(len(one.readings) for one in arrived) < 3000
    assert any(one.dropped for one in arrived)


def test_a_page_that_says_nothing_for_long_is_closed(page, monkeypatch):
    monkeypatch.setattr(site, "IDLE_S", 0.05)

    async def wait(line):
        return (await line.receive(timeout=3)).type

    answers, _ = talk(page, wait)

    assert answers == [aiohttp.WSMsgType.CLOSE]


def test_a_batch_that_does_not_end_is_given_up(page, monkeypatch):
    monkeypatch.setattr(site, "READ_S", 0.05)

    async def endless():
        yield b"{"
        await asyncio.Event().wait()

    with contextlib.suppress(aiohttp.ClientError):
        status, _, _ = post(page, endless())
        assert status == 408

    assert ask(page, f"/{TOKEN}/alive")[0] == 200


def test_more_connections_than_phones_are_turned_away(own_page, monkeypatch):
    monkeypatch.setattr(server, "MOST_CONNECTIONS", 1)

    async def second(line):
        with pytest.raises((aiohttp.ClientError, ConnectionError)):
            await asking(own_page, f"/{TOKEN}/alive")

    talk(own_page, saying(batch()), second)


def test_plain_noise_on_the_port_harms_nobody(page):
    with socket.create_connection(("127.0.0.1", page.port)) as stranger:
        stranger.sendall(b"GET / HTTP/1.1\r\n\r\n" + bytes(range(256)))

    assert ask(page, f"/{TOKEN}/alive")[0] == 200


def test_it_stops_at_once_and_the_port_is_free_again(own_page):
    async def stop(line):
        began_s = time.monotonic()
        await asyncio.to_thread(own_page.close)
        return time.monotonic() - began_s

    [took_s], _ = talk(own_page, stop)

    assert took_s < 1.0
    again = PhonePage(Settings(port=own_page.port, token=TOKEN), own_page._folder)
    again.open()
    again.close()


def test_a_port_that_is_taken_is_told(page):
    second = PhonePage(Settings(port=page.port), page._folder)

    with pytest.raises(PortTaken, match=str(page.port)):
        second.open()
    second.close()


def test_without_a_token_a_new_one_is_made_each_time(folder):
    first, second = PhonePage(Settings(port=1), folder), PhonePage(Settings(port=1), folder)

    assert first.token != second.token
    assert len(first.token) >= 12


def test_the_way_tells_where_and_keeps_the_users_token_for_itself(folder):
    own = PhonePage(Settings(port=8443, token="secret"), folder)
    made = PhonePage(Settings(port=8443), folder)

    assert (
        str(own.where)
        == "waits for a phone that opens its page on port 8443 (from this computer only)"
    )
    assert made.token in str(made.where)
    assert "listen on" in str(own.missing)
    assert own.hand == ""
    own.close()


def test_callers_who_never_greet_are_turned_away_before_they_take_memory(own_page, monkeypatch):
    monkeypatch.setattr(server, "MOST_CONNECTIONS", 3)
    silent = [socket.create_connection(("127.0.0.1", own_page.port)) for _ in range(8)]

    ends = [one for one in silent if _is_left(one)]
    began_s = time.monotonic()
    own_page.close()

    assert len(ends) == 5
    assert time.monotonic() - began_s < 1.0
    for one in silent:
        one.close()


def _is_left(caller):
    """Whether the page closes this connection at once."""
    caller.settimeout(0.2)
    try:
        return caller.recv(1) == b""
    except ConnectionResetError:
        return True
    except TimeoutError:
        return False
