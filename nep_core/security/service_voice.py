"""What a service of an opened network says on ``/node_state``: it is no node, but has news."""

from __future__ import annotations

import logging
import os
import socket
from collections.abc import Callable

from nep_core.errors import NepError
from nep_core.messages import NODE_STATE, NodeState
from nep_core.network import Network
from nep_core.pubsub import Publisher

log = logging.getLogger(__name__)


class ServiceVoice:
    """Speaks as ``name``; joins its network when there is something to say."""

    def __init__(self, name: str, join: Callable[[], Network]) -> None:
        self._name = name
        self._join = join
        self._network: Network | None = None
        self._states: Publisher | None = None

    def warn(self, sentence: str) -> None:
        """Tell of something that a person should look at."""
        log.warning("%s", sentence)
        try:
            self._publisher().send(
                NodeState(
                    node=self._name,
                    type="cognitive",  # the four types are of nodes, which this is not
                    event="warning",
                    description=sentence,
                    pid=os.getpid(),
                    host=socket.gethostname(),
                )
            )
        except NepError as error:
            log.warning("%s could not tell its warning: %s", self._name, error)

    def close(self) -> None:
        """Leave the network, before the service ends."""
        if self._network is not None:
            self._network.close()

    def _publisher(self) -> Publisher:
        if self._states is None:
            self._network = self._network or self._join()
            self._states = Publisher(NODE_STATE, network=self._network)
        return self._states
