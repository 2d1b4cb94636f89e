"""What can go wrong, as one tree.

NepError
├── NetworkError
│   ├── MasterNotFound        no NEP master answers
│   ├── PortTaken             an endpoint is used by another program
│   ├── NameTaken             a node of this name is already running
│   └── BadMessage            a message lacks a key or has one of the wrong type
├── NodeError
│   ├── ManifestError         a node's description file is wrong
│   ├── NodeNotFound          no node of this type and name
│   ├── ParameterError        a parameter that the node does not take, or a wrong value
│   └── NodeStartError        a node did not become ready
├── RobotError
│   ├── RobotNotAnswering     no action node plays this robot
│   └── ActionFailed          the robot could not do what it was asked
└── RecordingError            a recording or a model file that cannot be used
"""

from __future__ import annotations


class NepError(Exception):
    """An error that a person can act on: what happened, and a checklist of what to try in order."""

    title = "Something went wrong"

    def __init__(
        self, sentence: str, *, checklist: tuple[str, ...] = (), details: str = ""
    ) -> None:
        super().__init__(sentence)
        self.sentence = sentence
        self.checklist = checklist
        self.details = details


class NetworkError(NepError):
    """Two programs could not talk."""

    title = "The programs cannot talk to each other"


class MasterNotFound(NetworkError):
    """No NEP master answers at its endpoint."""

    title = "The NEP master does not answer"


class PortTaken(NetworkError):
    """An endpoint is used by another program."""

    title = "A port is already in use"


class NameTaken(NetworkError):
    """A node of this name is already running."""

    title = "Two nodes have the same name"


class BadMessage(NetworkError):
    """A message lacks a key, or has one of the wrong type."""

    title = "A message could not be read"


class NodeError(NepError):
    """A node could not be described, found or started."""

    title = "A node cannot run"


class ManifestError(NodeError):
    """A node's description file is wrong."""

    title = "A node's description is wrong"


class NodeNotFound(NodeError):
    """There is no node of this type and name."""

    title = "There is no such node"


class ParameterError(NodeError):
    """A parameter that the node does not take, or a value that it cannot have."""

    title = "A node was started with a wrong setting"


class NodeStartError(NodeError):
    """A node did not become ready."""

    title = "A node did not start"


class RobotError(NepError):
    """A robot did not do what it was asked."""

    title = "The robot has a problem"


class RobotNotAnswering(RobotError):
    """No action node plays this robot."""

    title = "The robot does not answer"


class ActionFailed(RobotError):
    """The robot could not do what it was asked."""

    title = "The robot could not do it"


class RecordingError(NepError):
    """A recording or a model file cannot be used."""

    title = "A file cannot be used"
