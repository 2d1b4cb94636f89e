"""Words by which a program chooses what a robot can do, and robots that it keeps as values."""

from __future__ import annotations

import pytest

from nep_core import as_robot, as_text, emotion_state
from nep_core.errors import RobotError, ValueRefused
from nep_core.networks.zmq_networks import PeerNetwork
from nep_core.program import robot as robots
from nep_core.program.choices import EMOTIONS, chosen
from nep_core.program.robot import Robot
from nep_core.program.values import as_number, is_same, speak
from nep_core.wire.messages import RobotState


@pytest.mark.parametrize(
    ("word", "table", "value"),
    [
        ("posture_stand", "postures", "posture_stand"),
        ("stand", "postures", "posture_stand"),
        ("Sit and  relax", "postures", "posture_sit_relax"),
        ("blow a kiss", "animations", "blow_kiss"),
        ("HeadYaw", "joints", "HeadYaw"),
    ],
)
def test_a_word_may_be_the_value_or_what_blocks_call_it(word: str, table: str, value: str) -> None:
    assert chosen(word, table) == value


@pytest.mark.parametrize(("language", "word"), [("de", "sitzen"), ("fr", "assis"), ("ja", "座る")])
def test_a_word_may_be_of_the_language_of_the_program(language: str, word: str) -> None:
    speak(language)
    try:
        found = chosen(word, "postures", is_open=True)
    finally:
        speak("en")

    assert found == "posture_sit" or word not in labels(language)
    assert chosen("sitzen", "postures", is_open=True) == "sitzen"  # not of this program


def labels(language: str) -> list[str]:
    from nep_core.program.choices import _labels

    return [*_labels(language, "postures").values()]


def test_a_word_that_two_joints_have_is_none_of_them() -> None:
    english = "shoulder up and down"

    assert chosen(english, "joints", is_open=True) == english


@pytest.mark.parametrize("word", ["lefft", 3, True, None, ["left"]])
def test_what_is_not_known_is_told_with_what_is(word: object) -> None:
    with pytest.raises(RobotError) as refused:
        chosen(word, "hands")

    assert str(refused.value.sentence).endswith("is not known here. Known: left, right, both.")


def test_a_kind_of_robot_that_has_no_tables_here_knows_any_word(tmp_path) -> None:
    assert chosen("anything", "postures", str(tmp_path)) == "anything"
    with pytest.raises(RobotError):
        chosen(7, "postures", str(tmp_path))


def test_a_look_is_called_as_in_blocks() -> None:
    assert emotion_state("calm") == "emotion_neutral"
    assert [emotion_state(one) for one in EMOTIONS] == [f"emotion_{one}" for one in EMOTIONS]
    with pytest.raises(RobotError, match="bored"):
        emotion_state("bored")


# Robots as values.


@pytest.fixture
def known(network: PeerNetwork, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(robots, "_ROBOTS", {})


@pytest.mark.usefixtures("known")
def test_a_robot_is_found_by_its_name_whatever_its_capitals_are() -> None:
    nao, other = Robot("NAO"), Robot("Nelly")

    assert as_robot("NAO") is nao and as_robot(" nelly ") is other
    assert as_robot(other) is other


@pytest.mark.usefixtures("known")
@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ("Nely", "There is no robot called “Nely”. There are: NAO, Nelly."),
        (0, "A robot belongs here, and 0 is a number."),
        ([], "A robot belongs here, and [] is a list."),
    ],
)
def test_what_is_no_robot_of_the_program_is_refused(value: object, sentence: str) -> None:
    Robot("NAO"), Robot("Nelly")

    with pytest.raises(ValueRefused) as refused:
        as_robot(value)

    assert str(refused.value.sentence) == sentence


@pytest.mark.usefixtures("known")
def test_a_robot_is_told_by_its_name_and_is_equal_to_itself_alone() -> None:
    both = Robot(["NAO", "Nelly"])

    assert as_text(Robot("NAO")) == "NAO"
    assert as_text(both) == "NAO and Nelly"
    assert as_text([Robot("NAO"), 1]) == "NAO and 1"
    assert Robot("NAO") == Robot("NAO") and Robot("NAO") in {Robot("NAO")}
    assert not is_same(Robot("NAO"), "NAO") and not is_same(Robot("NAO"), both)
    assert repr(Robot("NAO")) == "Robot('NAO')"


@pytest.mark.usefixtures("known")
def test_a_robot_is_no_number_and_the_sentence_says_what_it_is() -> None:
    with pytest.raises(ValueRefused, match="A number belongs here, and NAO is a robot"):
        as_number(Robot("NAO"))


@pytest.mark.usefixtures("known")
def test_what_is_measured_has_the_words_of_blocks_and_refuses_others(monkeypatch) -> None:
    state = RobotState(
        robot="NAO", joints={"HeadYaw": 0.0}, sensors={"sonar_left": 0.5, "odd": 7.0}
    )
    monkeypatch.setattr(Robot, "_state", lambda self: state)
    nao = Robot("NAO")

    assert nao.sensor("sonar_left") == 50.0 and nao.sensor("odd") == 7.0
    assert nao.angle("HeadYaw") == 0.0
    for ask in (nao.sensor, nao.angle, nao.is_touched, nao.sees, nao.person_is, nao.is_doing):
        with pytest.raises(RobotError, match="“nonsense” is not known here"):
            ask("nonsense")
