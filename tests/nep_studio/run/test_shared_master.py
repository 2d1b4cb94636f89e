"""A session joins the master that is there for all programs, and keeps from those of others."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from nep_core.networks.master import Master
from nep_core.networks.master_messages import ask_master
from nep_core.networks.zmq_networks import PeerNetwork
from nep_studio.run.local_network import LocalNetwork
from nep_studio.run.plan import STUDIO

pytestmark = pytest.mark.long


@pytest.fixture
def usual_place(free_port: int, monkeypatch: pytest.MonkeyPatch) -> str:
    """Where masters are looked for on this computer."""
    place = f"tcp://127.0.0.1:{free_port}"
    monkeypatch.delenv("NEP_MASTER", raising=False)
    monkeypatch.setattr("nep_core.networks.endpoints.DEFAULT_MASTER", place)
    return place


@pytest.fixture
def local(tmp_path: Path) -> Iterator[LocalNetwork]:
    local = LocalNetwork(logs=tmp_path)
    yield local
    local.close()


def names_at(place: str) -> set[str]:
    listing = ask_master(place)
    return {told.node for told in listing.registrations} if listing else set()


def test_a_session_joins_a_master_that_is_there_for_all_programs(usual_place, local):
    shared = Master(usual_place, is_shared=True)

    local.open()
    names = names_at(usual_place)
    local.close()
    is_left_alone = ask_master(usual_place) is not None
    shared.close()

    assert local.shared_master == usual_place
    assert STUDIO in names
    assert is_left_alone


def test_two_sessions_do_not_disturb_each_other(usual_place, local, tmp_path):
    other = LocalNetwork(logs=tmp_path / "other")
    local.open()

    other.open()
    places = [local.launcher.master, other.launcher.master]
    other.close()

    assert places[0] == usual_place
    assert places[1] != usual_place
    assert not other.shared_master


def test_a_second_session_keeps_from_a_shared_master_that_has_one(usual_place, local, tmp_path):
    shared = Master(usual_place, is_shared=True)
    other = LocalNetwork(logs=tmp_path / "other")
    local.open()

    other.open()
    place = other.launcher.master
    other.close()
    local.close()
    shared.close()

    assert place != usual_place


def test_a_session_that_comes_second_by_a_moment_has_a_master_of_its_own(
    usual_place, local, monkeypatch
):
    shared = Master(usual_place, is_shared=True)
    first = PeerNetwork(STUDIO, master=usual_place)
    first.join()
    monkeypatch.setattr("nep_studio.run.local_network.shared_master", lambda studio: usual_place)

    local.open()
    place = local.launcher.master
    local.close()
    first.close()
    shared.close()

    assert place != usual_place
    assert not local.shared_master


def test_when_the_shared_master_is_gone_the_next_run_starts_one_in_its_place(usual_place, local):
    shared = Master(usual_place, is_shared=True)
    local.open()
    shared.close()

    local.open()

    assert ask_master(usual_place, timeout_s=5.0) is not None
    assert local.has_master
