from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nao_stage import BODY

from robots.body.choregraphe import KeyframesUnreadable, read_choregraphe
from robots.body.keyframes import Keyframes, Track

SIMPLE_PYTHON = """
# Choregraphe simplified export in Python.
from naoqi import ALProxy
names = list()
times = list()
keys = list()

names.append("HeadPitch")
times.append([0.8, 1.56])
keys.append([0.29602, -0.170316])

names.append("LHand")
times.append([ 0.24000])
keys.append([ 0.00028])

try:
  # uncomment the following line and modify the IP if you use this script outside Choregraphe.
  # motion = ALProxy("ALMotion", IP, 9559)
  motion = ALProxy("ALMotion")
  motion.angleInterpolation(names, keys, times, True)
except BaseException, err:
  print err
"""
BEZIER_PYTHON = """
# Choregraphe bezier export in Python.
session.connect("tcp://" + ip + ":" + port)
def main(robotIP, port):
  names = list()
  times = list()
  keys = list()

  names.append("HeadYaw")
  times.append([0.6, 0.84])
  keys.append([[-4.19617e-05, [3, -0.213333, 0], [3, 0.08, 0]],
               [0.010696, [3, -0.08, -0.00362582], [3, 0, 0]]])

  try:
    motion = ALProxy("ALMotion", robotIP, port)
    motion.angleInterpolationBezier(names, times, keys)
  except BaseException, err:
    print err
"""
BEZIER_CPP = """
void Dancer::dance(){
// Choregraphe bezier export in c++.
// Add #include <alproxies/almotionproxy.h> at the beginning of this file.
std::vector<std::string> names;
AL::ALValue times, keys;
names.reserve(2);
times.arraySetSize(2);
keys.arraySetSize(2);

names.push_back("HeadPitch");
times[0].arraySetSize(2);
keys[0].arraySetSize(2);

times[0][0] = 0.800000;
keys[0][0] = AL::ALValue::array(0.296020, AL::ALValue::array(3, -0.266667, -0.00000),
  AL::ALValue::array(3, 0.253333, 0.00000));
times[0][1] = 1.56000;
keys[0][1] = AL::ALValue::array(-0.170316, AL::ALValue::array(3, -0.253333, 0.111996),
  AL::ALValue::array(3, 0.226667, -0.100207));

names.push_back("HeadYaw");
times[1].arraySetSize(1);
keys[1].arraySetSize(1);

times[1][0] = 0.5;
keys[1][0] = -0.25;

try
{
  getParentBroker()->getMotionProxy()->angleInterpolationBezier(names, times, keys);
}
catch(const std::exception&)
{
}
}
"""


def test_the_simple_export_in_python_is_read_though_its_python_is_an_old_one() -> None:
    keyframes = read_choregraphe(SIMPLE_PYTHON)

    assert keyframes.tracks == {
        "HeadPitch": Track((0.8, 1.56), (0.29602, -0.170316)),
        "LHand": Track((0.24,), (0.00028,)),
    }


def test_the_bezier_export_in_python_keeps_its_handles() -> None:
    track = read_choregraphe(BEZIER_PYTHON).tracks["HeadYaw"]

    assert track.times == (0.6, 0.84)
    assert track.keys == (-4.19617e-05, 0.010696)
    assert track.handles == ((-0.213333, 0.0, 0.08, 0.0), (-0.08, -0.00362582, 0.0, 0.0))


def test_the_export_in_cpp_is_read_too() -> None:
    tracks = read_choregraphe(BEZIER_CPP).tracks

    assert tracks["HeadYaw"] == Track((0.5,), (-0.25,))
    assert tracks["HeadPitch"].times == (0.8, 1.56)
    assert tracks["HeadPitch"].handles is not None
    assert tracks["HeadPitch"].handles[1] == (-0.253333, 0.111996, 0.226667, -0.100207)


def test_lists_of_other_names_are_found_by_the_call_that_plays_them() -> None:
    text = """
    joints = ["LShoulderPitch", "LElbowRoll"]
    when = [0.5, 1.0]
    motion.angleInterpolation(joints, [[80*math.pi/180, 0.5], [-1.0, -20.0*almath.TO_RAD]],
                              [when, when], True)
    """

    tracks = read_choregraphe(text).tracks

    assert tracks["LShoulderPitch"].keys == pytest.approx((1.396263, 0.5))
    assert tracks["LElbowRoll"] == Track((0.5, 1.0), (-1.0, pytest.approx(-0.349066)))


def test_one_joint_may_be_played_alone() -> None:
    keyframes = read_choregraphe('motion.angleInterpolation("HeadYaw", [0.5, 0], [1, 2], True)')

    assert keyframes.tracks == {"HeadYaw": Track((1.0, 2.0), (0.5, 0.0))}


def test_a_key_at_the_very_beginning_is_reached_a_moment_later() -> None:
    keyframes = read_choregraphe('names=["HeadYaw"]\ntimes=[[0, 0.5]]\nkeys=[[[0.1],[0.2]]]')

    assert keyframes.tracks == {"HeadYaw": Track((0.01, 0.51), (0.1, 0.2))}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "no joint names, times and keys"),
        ("hello there", "no joint names, times and keys"),
        (SIMPLE_PYTHON + SIMPLE_PYTHON, "2 movements"),
        (SIMPLE_PYTHON.replace("0.8, 1.56", "0.8"), "HeadPitch has 1 times for 2 keys"),
        (SIMPLE_PYTHON.replace("0.8, 1.56", "0.8, 0.7"), "times of HeadPitch do not rise"),
        (SIMPLE_PYTHON.replace("0.8, 1.56", "-0.8, 0.7"), "times of HeadPitch do not rise"),
        (SIMPLE_PYTHON.replace('"LHand"', '"HeadPitch"'), "HeadPitch is there twice"),
        (SIMPLE_PYTHON.replace("0.29602", "1e999"), "numbers of HeadPitch cannot be read"),
        (SIMPLE_PYTHON.replace("0.29602", '"a"'), "numbers of HeadPitch cannot be read"),
        (SIMPLE_PYTHON.replace("0.29602", "[1, 2]"), "A key of HeadPitch is neither"),
        (SIMPLE_PYTHON.replace("times.append([ 0.24000])", ""), "2 joint names, but 1 lists"),
        ("x" * 2_000_001, "too long"),
    ],
)
def test_a_text_without_a_usable_movement_is_told_why(text: str, sentence: str) -> None:
    with pytest.raises(KeyframesUnreadable) as told:
        read_choregraphe(text)

    assert sentence in str(told.value.sentence) and told.value.checklist


def test_nothing_of_the_text_is_executed(tmp_path: Path) -> None:
    trap = f"open({str(tmp_path / 'trap')!r}, 'w')"

    read_choregraphe(SIMPLE_PYTHON + f"\n{trap}\nkeys.append({trap})\n")

    assert list(tmp_path.iterdir()) == []


@settings(deadline=None)
@given(st.text(alphabet='names.append(["HeadYaw"])timesky=0123456789,-\n{};#/\\', max_size=300))
def test_any_text_is_read_or_refused_with_a_sentence(text: str) -> None:
    try:
        assert read_choregraphe(text).tracks
    except KeyframesUnreadable as error:
        assert str(error.sentence).endswith(".")


numbers = st.floats(-3.0, 3.0).map(lambda x: round(x, 5))
steps = st.lists(st.floats(0.01, 3.0).map(lambda x: round(x, 3)), min_size=1, max_size=6)


@st.composite
def tracks(draw: st.DrawFn) -> Track:
    waits = draw(steps)
    times = tuple(round(sum(waits[: i + 1]), 3) for i in range(len(waits)))
    keys = tuple(draw(numbers) for _ in times)
    handle = st.tuples(numbers, numbers, numbers, numbers)
    handles = tuple(draw(handle) for _ in times) if draw(st.booleans()) else None
    return Track(times, keys, handles)


movements = st.dictionaries(st.sampled_from(BODY.names), tracks(), min_size=1, max_size=5)


def exported(keyframes: Keyframes) -> str:
    """As Choregraphe's Bezier export in Python writes it."""
    lines = ["names = list()", "times = list()", "keys = list()"]
    for name, track in keyframes.tracks.items():
        keys: list[object] = list(track.keys)
        if track.handles:
            joined = zip(track.keys, track.handles, strict=True)
            keys = [[key, [3, h[0], h[1]], [3, h[2], h[3]]] for key, h in joined]
        lines.append(f'names.append("{name}")')
        lines.append(f"times.append({json.dumps(track.times)})")
        lines.append(f"keys.append({json.dumps(keys)})")
    return "\n".join(lines)


@settings(deadline=None)
@given(movements.map(Keyframes))
def test_what_choregraphe_exports_is_read_as_it_was(keyframes: Keyframes) -> None:
    assert read_choregraphe(exported(keyframes)) == keyframes
