"""What can go wrong between a program and a NAOqi robot, as one tree.

NaoqiError (a RobotError: a sentence and a checklist)
├── NoConnection
│   ├── Refused             nothing listens at this address
│   ├── NoAnswer            nobody answered in time
│   ├── NotNaoqi            something answers that does not speak NAOqi
│   ├── NeedsTls            this port speaks TLS only
│   ├── NoTls               this port does not speak TLS
│   ├── StrangeCertificate  another robot than the one that was trusted
│   ├── LoginRefused        no user and password, or wrong ones
│   ├── NoRoom              as many programs as it serves are connected
│   └── ConnectionLost      the connection has ended
├── NoSuchService           the robot does not have this service
├── NoSuchMethod            the service does not have this method, signal or property
├── WrongArguments          no overload of the method takes these values
├── CallFailed              the service says why it could not
├── CallCancelled           the call was given up
└── BadFrame                bytes that are not a NAOqi message
"""

from __future__ import annotations

from robots.errors import RobotError


class NaoqiError(RobotError):
    """Something went wrong between this program and a NAOqi robot."""


class NoConnection(NaoqiError):
    """There is no connection to the robot."""

    title = "NAO cannot be reached"


class Refused(NoConnection):
    """Nothing listens at this address."""


class NoAnswer(NoConnection):
    """Nobody answered in time."""

    title = "NAO does not answer"


class UnknownAddress(NoAnswer):
    """Nothing on this network has this name."""


class NotNaoqi(NoConnection):
    """Something answers that does not speak NAOqi."""

    title = "This is not a NAOqi robot"


class NeedsTls(NoConnection):
    """This port speaks TLS only."""

    title = "NAO wants an encrypted connection"


class NoTls(NoConnection):
    """This port does not speak TLS."""

    title = "NAO does not encrypt here"


class StrangeCertificate(NoConnection):
    """The certificate is not the one that was trusted before."""

    title = "Another robot answers"


class LoginRefused(NoConnection):
    """The robot wants a user and a password, or refuses these."""

    title = "NAO refuses the login"


class NoRoom(NoConnection):
    """As many programs as the robot serves are connected."""

    title = "NAO serves no more programs"


class ConnectionLost(NoConnection):
    """The connection has ended."""

    title = "The connection to NAO is lost"


class NoSuchService(NaoqiError):
    """The robot does not have this service."""

    title = "NAO does not have this service"


class NoSuchMethod(NaoqiError):
    """The service does not have this method, signal or property."""

    title = "NAO cannot do this"


class WrongArguments(NaoqiError):
    """No overload of the method takes these values."""

    title = "NAO does not understand these values"


class CallFailed(NaoqiError):
    """The service says why it could not: this text is what the caller gets."""

    title = "NAO could not do it"


class CallCancelled(NaoqiError):
    """The call was given up before it ended."""

    title = "NAO stopped"


class BadFrame(NaoqiError):
    """Bytes that are not a NAOqi message."""

    title = "A message of NAO could not be read"
