"""``nep-studio naoqi``: a virtual NAO that programs made for a real one reach as if it were one."""

from __future__ import annotations

import argparse
import contextlib
import logging
import os
import signal
import socket
import threading
from collections.abc import Iterator

from faults import text_of
from nep_core.errors import NepError, PortTaken
from nep_core.networks.endpoints import master_endpoint
from nep_core.networks.master_messages import ask_master
from nep_core.networks.transports import network_for, transport
from nep_core.places import log_folder
from nep_core.processes.launcher import Launcher
from nep_core.processes.manifest import Value
from nep_core.processes.node import STOP_SIGNALS, check_node_name
from nep_core.processes.process import ON_WINDOWS
from nep_studio.run.local_network import start_master

from .project import explain, speed

FAILED = 1
PORT = 9559
LOGIN = "NEP_NAOQI_LOGIN"
"""The variable in which the node finds the login: command lines can be read by everybody."""
NODE = "action/nao"
LOOK_S = 0.2

ON = """{robot} is on. Programs made for a real NAO reach it at tcp://127.0.0.1:{port}{login}

With the package qi, in Python:

  session = qi.Session()
  session.connect("tcp://127.0.0.1:{port}")
  session.service("ALTextToSpeech").say("Hello")

A program that uses qi.Application takes --qi-url=tcp://127.0.0.1:{port}{default}
Ctrl-C switches {robot} off.
"""
DEFAULT = ",\nand needs nothing at all at this port: it is the one where they look for NAO."


def main(arguments: list[str]) -> int:
    """Offer a robot until Ctrl-C; 0, or 1 when it could not be offered."""
    options = _parser().parse_args(arguments)
    if options.robot is None:  # a name of its own: the project that runs beside it has a NAO
        options.robot = f"NAO-{options.port}"
    logging.basicConfig(level=logging.ERROR, format="%(message)s")
    stop = threading.Event()
    for number in STOP_SIGNALS:
        signal.signal(number, lambda *_: stop.set())
    if options.login:
        os.environ[LOGIN] = options.login
    try:
        check_node_name(options.robot)
        _check_free(options.port)
        with _network() as launcher:
            _offer(launcher, options, stop)
    except NepError as error:
        explain(error)
        return FAILED
    print(f"{options.robot} is off.", flush=True)
    return 0


@contextlib.contextmanager
def _network() -> Iterator[Launcher]:
    """Join the network of a master that runs, such as the studio's, or start one."""
    with contextlib.ExitStack() as stack:
        services = Launcher(logs=log_folder())
        stack.callback(services.close)
        master = master_endpoint()
        if transport() == "p2p" and ask_master(master, timeout_s=LOOK_S) is None:
            master = start_master(services)
        network = stack.enter_context(network_for(f"naoqi-{os.getpid()}", master=master))
        launcher = Launcher(logs=log_folder(), master=master)
        stack.callback(launcher.close)
        launcher.hear(network)
        yield launcher


def _check_free(port: int) -> None:
    """Raise PortTaken with what to type instead; the node would say less, and later."""
    with socket.socket() as probe:
        if not ON_WINDOWS:  # there it would let two programs have one port
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(("127.0.0.1", port))
        except OSError as error:
            raise PortTaken(
                "Port {port} of this computer is used by another program.",
                checklist=(
                    "Is another NAO offered already, or Choregraphe's virtual robot? Close it.",
                    text_of("Or take another port: nep-studio naoqi --port {port}", port=port + 1),
                ),
                details=str(error),
                port=port,
            ) from error


def _offer(launcher: Launcher, options: argparse.Namespace, stop: threading.Event) -> None:
    """Start the robot, say where it is, and wait until ``stop``.

    Raises NepError when it ends by itself.
    """
    settings: dict[str, Value] = {
        "robot": options.robot,
        "speed": options.speed,
        "naoqi_port": options.port,
        "model": options.model,
    }
    robot = launcher.launch(NODE, options.robot, settings, restart="on-kill")
    robot.wait_ready(given_up=stop)
    if not stop.is_set():
        print(_welcome(options), flush=True)
    while not stop.is_set() and not robot.ended.wait(LOOK_S):
        pass
    robot.wait_ready(0.0, given_up=stop)


def _welcome(options: argparse.Namespace) -> str:
    user = (options.login or "").partition(":")[0]
    return ON.format(
        robot=options.robot,
        port=options.port,
        login=f",\nas user {user} with the password that was given." if user else ".",
        default=DEFAULT if options.port == PORT and not user else ".",
    )


def _login(word: str) -> str:
    user, colon, password = word.partition(":")
    if not (user and colon and password):
        raise argparse.ArgumentTypeError("write user:password, such as nao:secret")
    return word


def _port(word: str) -> int:
    if not (word.isascii() and word.isdigit() and 0 < int(word) < 65536):
        raise argparse.ArgumentTypeError(f'"{word}" is not a port: a number from 1 to 65535')
    return int(word)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="nep-studio naoqi",
        description="Offer a virtual NAO to programs made for a real one, on this computer only. "
        "It joins a network that is running, so that the studio shows it.",
    )
    parser.add_argument(
        "--port",
        type=_port,
        default=PORT,
        metavar="N",
        help="where to listen (default: %(default)s)",
    )
    parser.add_argument(
        "--robot", metavar="NAME", help="the robot's name (default: NAO and its port)"
    )
    parser.add_argument(
        "--model",
        default="nao",
        metavar="NAME",
        help="which robot it is: nao, pepper, or a folder with one of your own "
        "(default: %(default)s)",
    )
    parser.add_argument(
        "--speed",
        type=speed,
        default=1.0,
        metavar="N",
        help="let the robot live N times as fast: 0.1 to 50",
    )
    parser.add_argument(
        "--login",
        type=_login,
        metavar="USER:PASSWORD",
        help="let programs in that give these only, as NAOqi 2.9 and later does",
    )
    return parser
