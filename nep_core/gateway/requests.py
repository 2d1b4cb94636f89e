"""What programs of the original ask for, and the answers that they understand."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Literal, cast

from nep_core.errors import BadMessage, NetworkError
from nep_core.frames import check_topic, to_json
from nep_core.gateway.shapes import Shape, shape_of

Mode = Literal["many2many", "one2many", "many2one"]
Role = Literal["publisher", "subscriber", "service", "unknown"]

MODES = ("many2many", "one2many", "many2one")
SERVICES = ("client", "server", "surveyor", "respondent")
MAX_PID = 2**31 - 1


@dataclass(frozen=True)
class Request:
    """A program asks at which port it finds a topic.

    ``paper`` is how the paper's own programs ask: they do not say what they are going to do.
    """

    node: str
    topic: str
    role: Role
    mode: Mode
    socket: str
    msg_type: str
    shape: Shape
    pid: int = 0
    paper: bool = False


def read_request(frame: bytes, old: bool) -> Request:
    """Take a request in; raises BadMessage. Only the topic must be there."""
    told = _told(frame)
    topic = told.get("topic")
    if not isinstance(topic, str):
        raise BadMessage('The request has no "topic".')
    try:
        check_topic(topic)
    except NetworkError as error:
        raise BadMessage(error.sentence) from error
    paper = "node_name" in told and "node" not in told
    mode = _text(told, "mode", "one2many" if paper else "many2many")
    if mode not in MODES:
        raise BadMessage(f"There is no mode {mode!r}: use one of {', '.join(MODES)}.")
    socket = _text(told, "socket", "unknown")
    msg_type = _text(told, "msg_type", "json")
    return Request(
        node=_text(told, "node_name" if paper else "node", "default"),
        topic=topic,
        role=_role(socket),
        mode=cast(Mode, mode),
        socket=socket,
        msg_type=msg_type,
        shape=shape_of(msg_type, old),
        pid=_pid(told.get("pid")),
        paper=paper,
    )


def granted(request: Request, port: int, ip: str) -> bytes:
    """The answer that names the port."""
    answer: dict[str, Any] = {"topic": request.topic, "port": port}
    if not request.paper:
        answer |= {"ip": ip, "socket": request.socket, "state": "success"}
        if request.role != "service":
            answer["mode"] = request.mode
    return to_json(answer)


def refused(frame: bytes, sentence: str, ip: str) -> bytes:
    """The answer to what cannot be: their clients go on without that topic.

    They would wait for ever for an answer that names another topic than they asked for.
    """
    try:
        topic = _told(frame).get("topic", "")
    except BadMessage:
        topic = ""
    answer = {"topic": topic, "port": 0, "ip": ip, "state": "failure", "error": sentence}
    return json.dumps(answer).encode()  # a topic of half a character is answered too


def _told(frame: bytes) -> dict[str, Any]:
    try:
        told = json.loads(frame)
    except (ValueError, RecursionError) as error:
        raise BadMessage(f"The request cannot be read: {error}.") from error
    if not isinstance(told, dict):
        raise BadMessage("The request is not a JSON object.")
    return told


def _text(told: dict[str, Any], key: str, default: str) -> str:
    """A text that can be sent on; whatever else is there counts as nothing."""
    value = told.get(key)
    if not isinstance(value, str):
        return default
    return value.encode(errors="replace").decode()


def _role(socket: str) -> Role:
    if socket in SERVICES:
        return "service"
    return cast(Role, socket) if socket in ("publisher", "subscriber") else "unknown"


def _pid(told: object) -> int:
    is_number = isinstance(told, int) and not isinstance(told, bool)
    return cast(int, told) if is_number and 0 < cast(int, told) <= MAX_PID else 0
