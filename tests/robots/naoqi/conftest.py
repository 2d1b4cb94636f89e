"""A lamp that speaks NAOqi, and a virtual NAO that does: our servers, and our client at them."""

from collections.abc import Iterator

import pytest
from naoqi_lamp import CallingLamp, lamp_server
from naoqi_theatre import NaoqiTheatre

from robots.naoqi.client.session import Session
from robots.naoqi.server.server import Server
from robots.naoqi.wire.remote import RemoteObject


@pytest.fixture
def lamp_serving() -> Iterator[tuple[CallingLamp, Server]]:
    with lamp_server() as pair:
        yield pair


@pytest.fixture
def lamp_session(lamp_serving: tuple[CallingLamp, Server]) -> Iterator[Session]:
    session = Session(("127.0.0.1", lamp_serving[1].port))
    session.connect()
    yield session
    session.close()


@pytest.fixture
def lamp(lamp_serving: tuple[CallingLamp, Server]) -> CallingLamp:
    return lamp_serving[0]


@pytest.fixture
def lamp_remote(lamp_session: Session) -> RemoteObject:
    return lamp_session.service("Lamp")


@pytest.fixture
def theatre() -> Iterator[NaoqiTheatre]:
    """A robot that lives ten times as fast as a real one."""
    theatre = NaoqiTheatre(speed=10)
    yield theatre
    theatre.close()


@pytest.fixture
def real_time() -> Iterator[NaoqiTheatre]:
    """A robot that lives as fast as a real one."""
    theatre = NaoqiTheatre()
    yield theatre
    theatre.close()
