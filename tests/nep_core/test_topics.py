"""The listing of topics: who is at which end."""

from __future__ import annotations

from nep_core.networks.registry import Registration
from nep_core.networks.transports import TopicEnds, topics_of


def registration(node: str, publishes: list[str], *subscribes: str) -> Registration:
    ids = {f"{node}-{number}": topic for number, topic in enumerate(subscribes)}
    return Registration(
        instance=node,
        node=node,
        pid=1,
        host="here",
        endpoint="tcp://127.0.0.1:1",
        publishes=publishes,
        subscribes=ids,
    )


def test_each_topic_has_its_publishers_and_subscribers() -> None:
    watch = registration("watch", ["/imu"])
    karate = registration("karate", ["/human_behavior"], "/imu")
    other = registration("hand_up", ["/human_behavior"], "/imu")

    found = topics_of([watch, karate, other])

    assert found == [
        TopicEnds("/human_behavior", ("hand_up", "karate"), ()),
        TopicEnds("/imu", ("watch",), ("hand_up", "karate")),
    ]


def test_a_node_that_hears_a_topic_twice_is_listed_once() -> None:
    found = topics_of([registration("both", [], "/imu", "/imu")])

    assert found == [TopicEnds("/imu", (), ("both",))]


def test_nobody_there_means_no_topics() -> None:
    assert topics_of([]) == []
