"""``nep-studio train``: recordings in, a model and a report out."""

import sys

import pytest

from nodes.perceptual.recognition.command import main
from nodes.perceptual.recognition.model import read_model
from nodes.recordings import write_recording
from nodes.sensory.arm.people import simulate_everyday, simulate_session

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    root = tmp_path_factory.mktemp("training")
    for name in ("gestures", "everyday"):
        (root / name).mkdir()
    write_recording(root / "gestures" / "ann.csv", simulate_session(5, ("karate",), 3))
    write_recording(root / "everyday" / "bob.csv", simulate_everyday(6, 30.0))
    return root


def test_recordings_become_a_model_and_a_report(folders, tmp_path, capsys):
    before = {path: path.read_bytes() for path in folders.rglob("*.csv")}
    model = tmp_path / "mine.gestures"

    everyday = ["--everyday", str(folders / "everyday")]
    code = main([str(folders / "gestures"), "-o", str(model), *everyday])

    told = capsys.readouterr().out
    assert code == 0
    assert "trees: gestures recognised in recordings that were left out" in told
    assert "gmr: gestures recognised" in told
    assert "karate: 3 of 3" in told
    assert "false triggers a minute, in 0.5 minutes" in told
    assert "Record karate 5 times or more" in told
    assert "Nothing could be confused with karate yet: add another gesture." in told
    assert "on 1 simulated recording of 1 person" in told
    assert f"The model is in {model}." in told
    assert read_model(model).names == ("karate",)
    assert {path: path.read_bytes() for path in folders.rglob("*.csv")} == before
    assert [path.name for path in tmp_path.iterdir()] == ["mine.gestures"]


def test_one_method_may_be_chosen(folders, tmp_path):
    model = tmp_path / "mine.gestures"
    everyday = ["--everyday", str(folders / "everyday")]

    code = main([str(folders / "gestures"), "-o", str(model), "--method", "gmr", *everyday])

    assert code == 0
    assert {one.method for one in read_model(model).recognisers} == {"gmr"}


def csv(folder, *lines):
    text = "\n".join(["t_s,ax,ay,az,gesture", *lines])
    (folder / "ann_wave.csv").write_text(text, encoding="utf-8")


def moving(seconds, rate_hz, gesture):
    return [f"{n / rate_hz:.3f},{n % 7},{n % 5},9,{gesture(n)}" for n in range(seconds * rate_hz)]


@pytest.mark.parametrize(
    ("lines", "sentence"),
    [
        (moving(4, 50, lambda n: 0), "No gesture is marked in the recordings ann_wave"),
        (moving(4, 50, lambda n: int(n == 20)), '"wave" at 0.40 s lasts 0.00 s'),
        (moving(30, 50, lambda n: int(n > 50)), "s, too long."),
        (moving(9, 5, lambda n: int(n % 10 > 5)), "5.0 samples a second, which is too few"),
        (["0,1,2,three,0"], "ann_wave.csv"),
        (moving(4, 50, lambda n: "\x1b[2J" if n < 50 else 0), "has a name that is too long, or"),
        (moving(4, 50, lambda n: "x" * 101 if n < 50 else 0), "the gesture at 0.00 s has a name"),
    ],
)
def test_recordings_that_cannot_be_learned_from_are_told(tmp_path, capsys, lines, sentence):
    csv(tmp_path, *lines)

    code = main([str(tmp_path), "-o", str(tmp_path / "mine.gestures")])

    told = capsys.readouterr().err
    assert code == 2
    assert sentence in told
    assert "[ ]" in told
    assert "Traceback" not in told
    assert "\x1b" not in told
    assert not (tmp_path / "mine.gestures").exists()


def test_an_empty_folder_a_wrong_name_and_a_place_that_is_not_there_are_told(tmp_path, capsys):
    assert main([str(tmp_path), "-o", str(tmp_path / "mine.gestures")]) == 2
    assert "has no recordings" in capsys.readouterr().err
    assert main([str(tmp_path), "-o", str(tmp_path / "mine.csv")]) == 2
    assert "would not be known as a gesture model" in capsys.readouterr().err
    assert main([str(tmp_path), "-o", str(tmp_path / "nowhere" / "mine.gestures")]) == 2
    assert "nowhere is not there" in capsys.readouterr().err


def test_a_model_that_is_already_there_is_kept_unless_it_shall_be_replaced(
    folders, tmp_path, capsys
):
    model = tmp_path / "mine.gestures"
    model.write_text("old")
    words = [str(folders / "gestures"), "-o", str(model), "--method", "gmr"]
    words += ["--everyday", str(folders / "everyday")]

    assert main(words) == 2
    told = capsys.readouterr()
    assert f"{model} is already there" in told.err
    assert "--replace" in told.err
    assert "Training" not in told.out
    assert model.read_text() == "old"

    assert main([*words, "--replace"]) == 0
    assert read_model(model).names == ("karate",)


def test_a_folder_in_the_models_place_is_told(folders, tmp_path, capsys):
    (tmp_path / "mine.gestures").mkdir()

    code = main([str(folders / "gestures"), "-o", str(tmp_path / "mine.gestures"), "--replace"])

    assert code == 2
    assert "is a folder" in capsys.readouterr().err


@pytest.mark.skipif(sys.platform != "linux", reason="needs a folder that nobody may write into")
def test_a_place_that_cannot_be_written_is_told_before_the_training(folders, capsys):
    code = main([str(folders / "gestures"), "-o", "/proc/mine.gestures"])

    told = capsys.readouterr()
    assert code == 2
    assert "mine.gestures cannot be written" in told.err
    assert "[ ] Choose a folder that you may write into" in told.err
    assert "Training" not in told.out


def test_a_gesture_made_once_is_trained_but_not_checked(tmp_path, capsys, folders):
    csv(tmp_path, *moving(6, 50, lambda n: int(100 < n < 150)))

    code = main(
        [
            str(tmp_path),
            "-o",
            str(tmp_path / "mine.gestures"),
            "--everyday",
            str(folders / "everyday"),
        ]
    )

    assert code == 0
    assert (
        "not checked. To check it, record each gesture at least twice." in capsys.readouterr().out
    )
