"""A gateway on free ports with our master behind it, and programs of the original as sockets."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from nep_core.networks.gateway.gateway import Gateway, Ports
from nep_core.networks.master import Master
from tests.nep_core.gateway.raw_programs import RawPrograms, free_ports


@pytest.fixture
def ports() -> Ports:
    return free_ports()


@pytest.fixture
def gateway(master: Master, ports: Ports) -> Iterator[Gateway]:
    opened = Gateway(master.endpoint, ports)
    yield opened
    opened.close()


@pytest.fixture
def raw(gateway: Gateway) -> Iterator[RawPrograms]:
    programs = RawPrograms(gateway.ports)
    yield programs
    programs.close()
