"""Asks the phone page's server as a browser does."""

from __future__ import annotations

import asyncio
import json
import ssl

import aiohttp

TOKEN = "right-token"
_runner = asyncio.Runner()
"""One loop for all tests, so that each connection has the time to close."""


def finish():
    """No more questions."""
    global _runner
    _runner.close()
    _runner = asyncio.Runner()


def trusting(page):
    """Only the page's own certificate is believed, as a phone that has accepted it does."""
    return ssl.create_default_context(cafile=str(page.certificate.path))


async def asking(page, path, method="GET", **more):
    """The status, headers and text of an answer."""
    async with aiohttp.ClientSession() as session:
        url = f"https://127.0.0.1:{page.port}{path}"
        asked = session.request(method, url, ssl=trusting(page), allow_redirects=False, **more)
        async with asked as answer:
            return answer.status, answer.headers, await answer.text()


def ask(page, path, method="GET", **more):
    return _runner.run(asking(page, path, method, **more))


def batch(*t, phone="a1", **more):
    told = {
        "id": phone,
        "t": list(t),
        "acc": [[0.0, 0.0, 9.81]] * len(t),
        "gyr": [[0.1, 0.2, 0.3]] * len(t),
    }
    return json.dumps(told | more)


def posting(page, text):
    own = {"Origin": f"https://127.0.0.1:{page.port}"}
    return asking(page, f"/{TOKEN}/batch", "POST", data=text, headers=own)


def post(page, text):
    return _runner.run(posting(page, text))


def talk(page, *steps):
    """A WebSocket of the page: sends each text, gives what is answered."""

    async def go():
        async with aiohttp.ClientSession() as session:
            url = f"https://127.0.0.1:{page.port}/{TOKEN}/motion"
            own = f"https://127.0.0.1:{page.port}"
            async with session.ws_connect(url, ssl=trusting(page), origin=own) as line:
                return [await step(line) for step in steps], line.close_code

    return _runner.run(go())


def saying(text):
    async def say(line):
        await line.send_str(text)
        answer = await line.receive(timeout=3)
        return json.loads(answer.data)["state"] if answer.type is aiohttp.WSMsgType.TEXT else None

    return say
