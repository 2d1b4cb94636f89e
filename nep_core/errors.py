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
├── ValueRefused              a value is of a kind or a size that a block cannot work with
├── PlanError                 what a program wants to reach cannot be reached
│   └── FactNotSo             a fact is not as a block needs or makes it
└── RecordingError            a recording or a model file that cannot be used
"""

from __future__ import annotations

from faults import FaultError


class NepError(FaultError):
    """An error of programs that talk to each other, or of what they are made of."""


class NetworkError(NepError, title="The programs cannot talk to each other"):
    """Two programs could not talk."""


class MasterNotFound(NetworkError, title="The NEP master does not answer"):
    """No NEP master answers at its endpoint."""


class NotLetIn(MasterNotFound, title="The network is closed to this program"):
    """A NEP master is there, but its keys and ours do not fit."""


class BrokerNotFound(MasterNotFound, title="The NEP broker does not answer"):
    """No NEP broker answers at its endpoint."""


class RouterNotFound(MasterNotFound, title="The zenoh router does not answer"):
    """No zenoh router answers at its endpoint."""


class PortTaken(NetworkError, title="A port is already in use"):
    """An endpoint is used by another program."""


class NameTaken(NetworkError, title="Two nodes have the same name"):
    """A node of this name is already running."""


class KeyFileError(NetworkError, title="The key file cannot be used"):
    """The key file of an opened network cannot be used."""


class PairingError(NetworkError, title="The computers were not paired"):
    """A second computer could not be paired."""


class BadMessage(NetworkError, title="A message could not be read"):
    """A message lacks a key, or has one of the wrong type."""


class NodeError(NepError, title="A node cannot run"):
    """A node could not be described, found or started."""


class ManifestError(NodeError, title="A node's description is wrong"):
    """A node's description file is wrong."""


class NodeNotFound(NodeError, title="There is no such node"):
    """There is no node of this type and name."""


class ParameterError(NodeError, title="A node was started with a wrong setting"):
    """A parameter that the node does not take, or a value that it cannot have."""


class NodeStartError(NodeError, title="A node did not start"):
    """A node did not become ready."""


class NodeStopError(NodeError, title="A node does not stop"):
    """A node did not stop when it was asked."""


class RobotError(NepError, title="The robot has a problem"):
    """A robot did not do what it was asked."""


class RobotNotAnswering(RobotError, title="The robot does not answer"):
    """No action node plays this robot."""


class ActionFailed(RobotError, title="The robot could not do it"):
    """The robot could not do what it was asked."""


class ValueRefused(NepError, title="The program stopped with an error"):
    """A value of a program is of a kind or a size that does not fit."""


class PlanError(NepError, title="No plan leads there"):
    """What a program wants to reach cannot be reached."""


class FactNotSo(PlanError, title="A fact is not so"):
    """A fact is not as a block needs it, or as it should have become."""


class RecordingError(NepError, title="A file cannot be used"):
    """A recording or a model file cannot be used."""
