"""Messages of a topic as text, files and things to send."""

from __future__ import annotations

import csv
import io
import json

import pytest

from nep_core.wire import messages as m
from nep_studio.ui.node_style import ago_words, pretty, rate_words, short_rate
from nep_studio.ui.plugins.network.sending import EXAMPLES, NotAMessage, example_of, read_message
from nep_studio.ui.plugins.network.topics import as_csv, as_json_lines, number_fields
from nep_studio.ui.running.runner import Heard

IMU = m.Imu(source="watch", rate_hz=50.0, t=[0.0, 0.1], acc=[(0.0, 1.0, 2.0), (3.0, 4.0, 5.0)])
ROBOT = m.RobotState(robot="NAO", joints={"HeadYaw": 0.5, "HeadPitch": 0.1}, time=10.0)


@pytest.mark.parametrize("topic", sorted(m.BY_TOPIC))
def test_the_example_of_every_topic_can_be_sent(topic: str) -> None:
    message = read_message(topic, example_of(topic))

    assert isinstance(message, m.BY_TOPIC[topic])
    assert topic in EXAMPLES


def test_another_topic_begins_with_its_last_message() -> None:
    assert json.loads(example_of("/mine", {"a": 1})) == {"a": 1}
    assert read_message("/mine", example_of("/mine", {"a": 1})) == {"a": 1}


def test_a_value_of_a_wrong_type_is_named() -> None:
    text = '{"human_state": "hello", "certainty": "high"}'

    with pytest.raises(NotAMessage, match="certainty"):
        read_message(m.HUMAN_BEHAVIOR, text)


def test_a_missing_value_is_named() -> None:
    with pytest.raises(NotAMessage, match="human_state"):
        read_message(m.HUMAN_BEHAVIOR, '{"certainty": 1.0}')


def test_a_misspelt_key_is_named_with_those_there_are() -> None:
    with pytest.raises(NotAMessage, match=r"humanstate.*human_state"):
        read_message(m.HUMAN_BEHAVIOR, '{"humanstate": "hello"}')


def test_broken_json_names_its_line() -> None:
    with pytest.raises(NotAMessage) as caught:
        read_message(m.HUMAN_BEHAVIOR, '{\n  "human_state": "a",\n  oops\n}')

    assert caught.value.line == 3


def test_json_that_stops_in_the_middle_is_told() -> None:
    with pytest.raises(NotAMessage, match="bracket"):
        read_message(m.HUMAN_BEHAVIOR, '{"human_state": "a"')


def test_a_message_is_shown_in_lines_that_are_json_again() -> None:
    assert json.loads(pretty(IMU))["acc"] == [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]
    assert '"t": [0.0, 0.1]' in pretty(IMU)
    assert pretty("a text") == "a text"


def test_csv_has_a_column_for_each_value() -> None:
    heard = [Heard(1.0, ROBOT, "NAO"), Heard(2.0, {"robot": "NAO", "new": 1}, "NAO")]

    rows = list(csv.DictReader(io.StringIO(as_csv(heard))))

    assert rows[0]["joints.HeadYaw"] == "0.5"
    assert rows[1]["new"] == "1"
    assert rows[0]["sender"] == "NAO"


def test_nothing_that_others_sent_is_a_formula_in_a_table() -> None:
    """Programs for tables reckon such a cell, or fetch what it names."""
    evil = "=HYPERLINK('http://stranger')"

    told = as_csv([Heard(1.0, {evil: evil, "sent": -1.5}, "NAO")])

    cells = [cell for row in csv.reader(io.StringIO(told)) for cell in row]
    assert not [cell for cell in cells if cell.startswith("=")]
    assert f"'{evil}" in cells and "-1.5" in cells


def test_json_lines_keep_whole_messages() -> None:
    [line] = as_json_lines([Heard(1.5, IMU, "watch")]).splitlines()

    assert json.loads(line)["message"]["acc"][1] == [3.0, 4.0, 5.0]


def test_numbers_and_rows_of_numbers_can_be_plotted() -> None:
    assert number_fields(ROBOT) == ["joints.HeadYaw", "joints.HeadPitch", "time"]
    assert set(number_fields(IMU)) == {"rate_hz", "t", "acc"}
    assert number_fields("a text") == []


def test_rates_and_times_are_said_in_words() -> None:
    assert rate_words(5000.4) == "5,000 a second"
    assert rate_words(0.0) == "quiet"
    assert short_rate(0.31) == "0.3/s"
    assert ago_words(100.0, 130.0) == "30 s ago"
    assert ago_words(0.0) == "never"
