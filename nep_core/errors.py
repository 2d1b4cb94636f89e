"""What can go wrong, as one tree.

NepError
├── NetworkError
│   ├── MasterNotFound        no NEP master answers
│   │   ├── NotLetIn          one does, but only to programs with its keys, or without any
│   │   ├── BrokerNotFound    no NEP broker answers, which takes its place
│   │   └── RouterNotFound    no zenoh router answers, which takes its place
│   ├── PortTaken             an endpoint is used by another program
│   ├── NameTaken             a node of this name is already running
│   ├── KeyFileError          the key file of an opened network cannot be used
│   ├── PairingError          a second computer could not be paired
│   └── BadMessage            a message lacks a key or has one of the wrong type
├── NodeError
│   ├── ManifestError         a node's description file is wrong
│   ├── NodeNotFound          no node of this type and name
│   ├── ParameterError        a parameter that the node does not take, or a wrong value
│   ├── NodeStartError        a node did not become ready
│   └── NodeStopError         a node did not stop when it was asked
├── RobotError
│   ├── RobotNotAnswering     no action node plays this robot
│   └── ActionFailed          the robot could not do what it was asked
└── RecordingError            a recording or a model file that cannot be used
"""

from __future__ import annotations

from faults import FaultError


class NepError(FaultError):
    """An error of programs that talk to each other, or of what they are made of."""


class NetworkError(NepError):
    """Two programs could not talk."""

    title = "The programs cannot talk to each other"


class MasterNotFound(NetworkError):
    """No NEP master answers at its endpoint."""

    title = "The NEP master does not answer"


class NotLetIn(MasterNotFound):
    """A NEP master is there, but its keys and ours do not fit."""

    title = "The network is closed to this program"


class BrokerNotFound(MasterNotFound):
    """No NEP broker answers at its endpoint."""

    title = "The NEP broker does not answer"


class RouterNotFound(MasterNotFound):
    """No zenoh router answers at its endpoint."""

    title = "The zenoh router does not answer"


class PortTaken(NetworkError):
    """An endpoint is used by another program."""

    title = "A port is already in use"


class NameTaken(NetworkError):
    """A node of this name is already running."""

    title = "Two nodes have the same name"


class KeyFileError(NetworkError):
    """The key file of an opened network cannot be used."""

    title = "The key file cannot be used"


class PairingError(NetworkError):
    """A second computer could not be paired."""

    title = "The computers were not paired"


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


class NodeStopError(NodeError):
    """A node did not stop when it was asked."""

    title = "A node does not stop"


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
