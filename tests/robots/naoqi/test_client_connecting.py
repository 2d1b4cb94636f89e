"""How our client finds, enters, loses and finds again our server."""

import threading
from typing import Any

import pytest
from naoqi_lamp import CERTIFICATE, KEY, CallingLamp, Lamp, lamp_server, until

from robots.errors import PortTaken
from robots.naoqi.client.session import Session
from robots.naoqi.server.server import Server
from robots.naoqi.wire.errors import ConnectionLost
from robots.naoqi.wire.line import Login, TlsFiles
from robots.naoqi.wire.remote import RemoteObject

LOGIN = Login("nao", "secret")


def test_a_session_connects_again_after_the_robot_was_away() -> None:
    lost: list[str] = []
    with lamp_server() as (_, server):
        port = server.port
        session = Session(("127.0.0.1", port), timeout_s=20.0)
        session.on_lost = lost.append
        session.connect()
        going = session.service("Lamp").begin("goToPosture", "Sit", 0.5)
    until(lambda: lost)
    with pytest.raises(ConnectionLost):
        going.result(2.0)
    with pytest.raises(ConnectionLost):
        session.service("Lamp")

    with lamp_server_at(port):
        session.connect()
        answer = session.service("Lamp").call("say", "again")
        session.close()

    assert answer == "s again"
    assert lost == ["The connection to NAO has ended."]


def lamp_server_at(port: int) -> Any:
    """Our server at this port, as a context."""

    class Serving:
        def __enter__(self) -> None:
            self.server = Server({"Lamp": Lamp()}, port=port)
            self.server.start()

        def __exit__(self, *_: object) -> None:
            self.server.stop()

    return Serving()


def test_nothing_is_told_as_lost_that_the_program_closed(lamp_session: Session) -> None:
    lost: list[str] = []
    lamp_session.on_lost = lost.append

    lamp_session.close()

    until(lambda: not any("client" in it.name for it in threading.enumerate()))
    assert lost == []


def test_a_port_that_is_taken_is_said_to_be(lamp_serving: tuple[CallingLamp, Server]) -> None:
    with pytest.raises(PortTaken, match="used by another program"):
        Server({}, port=lamp_serving[1].port).start()


def test_an_old_robot_without_authenticate_is_entered() -> None:
    with lamp_server(knows_authenticate=False) as (_, server):
        session = Session(("127.0.0.1", server.port))
        session.connect()

        assert session.service("Lamp").call("say", "a") == "s a"
        session.close()


@pytest.mark.parametrize("tls", [None, True])
def test_an_encrypted_robot_with_a_login_is_entered_and_known_by_its_fingerprint(
    tls: bool | None,
) -> None:
    with lamp_server(login=LOGIN, tls_files=TlsFiles(CERTIFICATE, KEY)) as (_, server):
        session = Session(("127.0.0.1", server.port), login=LOGIN, tls=tls)
        session.connect()
        again = Session(("127.0.0.1", server.port), login=LOGIN, trusted=session.fingerprint)
        again.connect()

        data = bytes(range(256)) * 4000
        assert again.service("Lamp").call("raw", data, timeout_s=10.0) == data[::-1]
        again.close()
        session.close()


def test_a_message_of_ten_megabytes_goes_both_ways(lamp_remote: RemoteObject) -> None:
    data = bytes(range(256)) * 40000

    assert lamp_remote.call("raw", data, timeout_s=20.0) == data[::-1]


def test_many_threads_use_one_session(lamp_remote: RemoteObject) -> None:
    wrong: list[object] = []

    def use(name: str) -> None:
        for number in range(100):
            answer = lamp_remote.call("say", f"{name} {number}", timeout_s=20.0)
            if answer != f"s {name} {number}":
                wrong.append(answer)

    threads = [threading.Thread(target=use, args=(str(it),)) for it in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(30.0)

    assert wrong == []
