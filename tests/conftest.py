"""What all tests share: a real master on a free port, networks that are closed, real recordings."""

from __future__ import annotations

import gc
import os
import signal
import socket
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TypeVar

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # threads cost each process 20 ms to start
os.environ.setdefault("NEP_ORIGINAL", "0")  # masters of tests that run at once would want one port

import psutil
import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis.vendor.pretty import for_type_by_name

from benchmarks.virtual_display import NoDisplay, virtual_display
from nep_core.networks.endpoints import MASTER_VARIABLE
from nep_core.networks.master import Master
from nep_core.networks.transports import set_default_network
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.places import ROBOT_FILES_VARIABLE

PROJECT = Path(__file__).resolve().parent.parent
Case = TypeVar("Case")

PART_IN_CI = 3
"""Of cases without number that are alike, CI tries one in so many."""
LONG_IN_CI = 4
"""Of long tests, CI plays one in so many."""
WHOLE_WINDOW = "studio"
"""Who uses this fixture opens the whole window, which makes a test a long one."""


def pytest_configure() -> None:
    """Let compiled code be kept: hundreds of processes would each compile all that they import."""
    is_judged = bool(os.environ.get("CI"))
    settings.register_profile(
        "busy",
        deadline=None,  # another program may have the processor for seconds
        suppress_health_check=[HealthCheck.too_slow],
        derandomize=is_judged,  # elsewhere we explore
        max_examples=30 if is_judged else 100,
        # a case that takes all the time of its test would be tried again and again, without end
        phases=[phase for phase in Phase if not (is_judged and phase is Phase.shrink)],
    )
    settings.load_profile("busy")
    # all its blocks would be told, and a warning of that hide what has failed
    for_type_by_name("nep_studio.blocks.language", "Language", lambda _, told, __: told.text("…"))
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:  # a shell started us in the background
        signal.signal(signal.SIGINT, signal.default_int_handler)  # else all children ignore Ctrl-C
    # who runs at once would take the usual port from each other as soon as a master is killed
    if worker := os.environ.get("PYTEST_XDIST_WORKER"):
        port = 17_100 + 10 * int(worker.removeprefix("gw"))
        os.environ[MASTER_VARIABLE] = f"tcp://127.0.0.1:{port}"
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In CI, play of each folder one in four of the long tests, always the same ones."""
    if not os.environ.get("CI") or config.getoption("lf", False):
        return
    numbers: Counter[Path] = Counter()
    left_out = []
    for item in items:
        uses = getattr(item, "fixturenames", ())
        if item.get_closest_marker("long") or WHOLE_WINDOW in uses:
            numbers[item.path.parent] += 1
            if numbers[item.path.parent] % LONG_IN_CI != 1:
                left_out.append(item)
    gone = set(left_out)
    items[:] = [item for item in items if item not in gone]
    config.hook.pytest_deselected(items=left_out)


def pytest_collection_finish() -> None:
    """Let the garbage collector pass by all that collecting the tests has made: it stays."""
    gc.collect()
    gc.freeze()


def a_part_of(cases: Iterable[Case]) -> list[Case]:
    """All of some cases; in CI one in three, always the same ones, from the whole range."""
    return list(cases)[:: PART_IN_CI if os.environ.get("CI") else 1]


@pytest.fixture(scope="session", autouse=True)
def nothing_waits_for_the_disk() -> Iterator[None]:
    """Tests do not switch the computer off: what is written need not be on the disk already."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "fsync", lambda _file: None)
        yield


@pytest.fixture
def shared_data() -> Path:
    """The recordings of real people, which are not part of the project."""
    folder = PROJECT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("the real recordings (../shared/data) are not here")
    return folder


@pytest.fixture(scope="session", autouse=True)
def robots_keep_files_elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Robots of tests leave no pictures in the folders of who runs them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(ROBOT_FILES_VARIABLE, str(tmp_path_factory.mktemp("robots")))
        yield


@pytest.fixture(autouse=True)
def projects_are_ours(request: pytest.FixtureRequest) -> Iterator[None]:
    """The projects of tests are approved; those of a test marked ``strangers`` are not."""
    if request.node.get_closest_marker("strangers"):
        yield
        return
    from nep_studio.run.gate import Gate

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Gate, "check_program", lambda *_: None)
        patch.setattr(Gate, "_is_known", lambda *_: True)
        yield


@pytest.fixture
def master(monkeypatch: pytest.MonkeyPatch) -> Iterator[Master]:
    """A running NEP Master, which this test and its child processes find."""
    running = Master("tcp://127.0.0.1:*")
    monkeypatch.setenv(MASTER_VARIABLE, running.endpoint)
    yield running
    running.close()


@pytest.fixture
def join(master: Master) -> Iterator[Callable[[str], PeerNetwork]]:
    """Makes p2p networks that are closed at the end."""
    networks: list[PeerNetwork] = []

    def make(node: str) -> PeerNetwork:
        networks.append(PeerNetwork(node, master=master.endpoint))
        return networks[-1]

    yield make
    for network in networks:
        network.close()


@pytest.fixture
def network(join: Callable[[str], PeerNetwork]) -> Iterator[PeerNetwork]:
    """The test's own network, which is also the default one."""
    own = join("test")
    set_default_network(own)
    yield own
    set_default_network(None)


def children() -> set[psutil.Process]:
    """The child processes; where Linux tells them, not all processes are looked through."""
    if hasattr(os, "waitid"):
        try:
            os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
        except ChildProcessError:  # most tests have none, but threads, which are slow to ask
            return set()
    told = list(Path("/proc/self/task").glob("*/children"))
    if not told:
        return set(psutil.Process().children())
    found = set()
    for path in told:
        with suppress(OSError, psutil.NoSuchProcess):  # a thread or a child that has ended by now
            found |= {psutil.Process(int(pid)) for pid in path.read_text().split()}
    return found


@pytest.fixture(autouse=True)
def leaves_no_child_processes() -> Iterator[None]:
    """A test that leaves a process running fails, and the process is ended."""
    before = children()
    yield
    left = [child for child in children() - before if child.is_running()]
    _, left = psutil.wait_procs(left, timeout=3)
    names = [" ".join(child.cmdline()) for child in left]
    for child in left:
        child.kill()
    assert not names, f"still running: {names}"


SPINNING_PART, LOOK_S, LOOKS = 0.5, 0.05, 60


def keeps_busy() -> bool:
    """Whether this process goes on working, for three seconds, while its main thread waits."""
    for _ in range(LOOKS):
        worked_s = time.process_time()
        time.sleep(LOOK_S)
        if time.process_time() - worked_s < SPINNING_PART * LOOK_S:
            return False
    return True


@pytest.fixture(scope="module", autouse=True)
def leaves_no_busy_threads() -> Iterator[None]:
    """A thread that never waits would take half of the processor from all tests after its own."""
    before = set(threading.enumerate())
    yield
    left = [thread.name for thread in threading.enumerate() if thread not in before]
    assert not left or not keeps_busy(), f"a thread still works, one of {left}"


def own_variables() -> dict[str, str]:
    """What the environment says to NEP."""
    return {name: value for name, value in os.environ.items() if name.startswith("NEP_")}


@pytest.fixture(autouse=True)
def leaves_the_environment(leaves_no_child_processes: None) -> Iterator[None]:
    """A test that leaves a variable for the next ones fails, and the variable is taken back."""
    before = own_variables()
    yield
    after = own_variables()
    for name in after.keys() - before.keys():
        del os.environ[name]
    os.environ.update(before)
    assert after == before


@pytest.fixture
def xvfb() -> Iterator[dict[str, str]]:
    """The environment for child processes that show their windows on a display of their own."""
    with ExitStack() as ending:
        try:
            environment = ending.enter_context(virtual_display())
        except NoDisplay as reason:
            pytest.skip(str(reason))
        yield environment


@pytest.fixture
def free_port() -> int:
    """A port that nobody used a moment ago, with the next two free too, as a broker needs them."""
    while True:
        with socket.socket() as first, socket.socket() as second, socket.socket() as third:
            first.bind(("127.0.0.1", 0))
            port = int(first.getsockname()[1])
            try:
                second.bind(("127.0.0.1", port + 1))
                third.bind(("127.0.0.1", port + 2))
            except (OSError, OverflowError):
                continue
            return port
