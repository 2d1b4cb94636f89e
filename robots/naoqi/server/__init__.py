"""A NAOqi "robot": the service directory and any services, for NAOqi programs.

    class ALBattery:
        @method("getBatteryCharge::i()")
        def charge(self) -> int:
            return 80

    server = Server({"ALBattery": ALBattery()}, port=9559)
    server.start()

``promise.future`` as the result of a method answers later; CallFailed is the text that the caller
gets; ``signal`` and ``Property`` declare what callers can listen to.
"""

from robots.naoqi.wire.errors import CallCancelled, CallFailed
from robots.naoqi.wire.line import Login, TlsFiles
from robots.naoqi.wire.promise import Pending, Promise
from robots.naoqi.wire.service import Property, Signal, caller, method, signal

from .module import Module
from .server import Server

__all__ = [
    "CallCancelled",
    "CallFailed",
    "Login",
    "Module",
    "Pending",
    "Promise",
    "Property",
    "Server",
    "Signal",
    "TlsFiles",
    "caller",
    "method",
    "signal",
]
