"""Which address of a service a client takes: the open connection or the robot's own."""

import pytest

from robots.naoqi.client.session import Place, best_place

ROBOT = ("192.168.1.10", 9559)
HERE = Place(1, "robot", ("tcp://127.0.0.1:9559", "tcp://192.168.1.10:9559"))


@pytest.mark.parametrize(
    ("address", "endpoints", "expected"),
    [
        (ROBOT, ("tcp://127.0.0.1:9559", "tcp://192.168.1.10:9559"), None),
        (ROBOT, (), None),
        (ROBOT, ("tcp://192.168.1.10:9559",), None),
        (
            ROBOT,
            ("tcp://127.0.0.1:40001", "tcp://10.0.0.3:40001", "tcp://192.168.1.10:40001"),
            ("192.168.1.10", 40001, False),
        ),
        (ROBOT, ("tcp://127.0.0.1:40001", "tcps://10.0.0.3:40001"), ("10.0.0.3", 40001, True)),
        (ROBOT, ("tcp://127.0.0.1:40001",), None),
        (("127.0.0.1", 9559), ("tcp://127.0.0.1:40001",), ("127.0.0.1", 40001, False)),
        (ROBOT, ("nonsense", "tcp://:1", "http://a:1", "tcp://a:b"), None),
        (ROBOT, ("tcp://a:²", f"tcp://a:{'1' * 5000}", "tcp://a:-1"), None),
        (("localhost", 19559), ("tcp://192.168.1.10:9559",), None),
    ],
)
def test_a_service_is_reached_where_it_is(
    address: tuple[str, int],
    endpoints: tuple[str, ...],
    expected: tuple[str, int, bool] | None,
) -> None:
    assert best_place(Place(7, "robot", endpoints), HERE, address) == expected
