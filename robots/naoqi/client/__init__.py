"""A connection to a NAOqi robot: its services, their methods and their signals.

    session = Session(("192.168.1.10", 9559), login=Login("nao", "nao"))
    session.connect()
    posture = session.service("ALRobotPosture")
    going = posture.begin("goToPosture", "Stand", 0.8)     # does not wait
    posture.call("getPosture")                             # waits, at most 2.5 s unless told
    memory = session.service("ALMemory")
    head = memory.call("subscriber", "FrontTactilTouched")
    end = head.connect("signal", lambda value: ...)

Every call ends in time: with its result, or with a NaoqiError that says what to do.
"""

from robots.naoqi.wire.errors import (
    CallCancelled,
    CallFailed,
    ConnectionLost,
    LoginRefused,
    NaoqiError,
    NeedsTls,
    NoAnswer,
    NoConnection,
    NoSuchMethod,
    NoSuchService,
    NoTls,
    NotNaoqi,
    Refused,
    StrangeCertificate,
    WrongArguments,
)
from robots.naoqi.wire.line import Login
from robots.naoqi.wire.metaobject import Signature
from robots.naoqi.wire.promise import Pending
from robots.naoqi.wire.remote import PATIENCE_S, RemoteObject
from robots.naoqi.wire.service import Property, Signal, method, signal

from .session import Session

__all__ = [
    "PATIENCE_S",
    "CallCancelled",
    "CallFailed",
    "ConnectionLost",
    "Login",
    "LoginRefused",
    "NaoqiError",
    "NeedsTls",
    "NoAnswer",
    "NoConnection",
    "NoSuchMethod",
    "NoSuchService",
    "NoTls",
    "NotNaoqi",
    "Pending",
    "Property",
    "Refused",
    "RemoteObject",
    "Session",
    "Signal",
    "Signature",
    "StrangeCertificate",
    "WrongArguments",
    "method",
    "signal",
]
