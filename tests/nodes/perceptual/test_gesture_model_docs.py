"""docs/gesture_models.md tells all that is in a model file, and its reader reads it."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from nodes.perceptual.recognition.features import feature_count
from nodes.perceptual.recognition.model import write_model

PAGE = (Path(__file__).parents[3] / "docs" / "gesture_models.md").read_text(encoding="utf-8")
ASKED = """
const model = readModel(process.argv[2]);
const features = JSON.parse(process.argv[3]);
const shapes = Object.entries(model.arrays).map(([name, { shape }]) => [name, shape]);
console.log(JSON.stringify({
  names: model.about.gestures.map((gesture) => gesture.name),
  shapes: Object.fromEntries(shapes),
  scores: scores(model, 0, features),
}));
"""


@pytest.fixture
def file(tmp_path, model):
    path = tmp_path / "mine.gestures"
    write_model(path, model)
    return path


def test_every_array_and_every_key_is_described(file):
    with np.load(file, allow_pickle=False) as content:
        arrays = {re.sub(r"^\d+\.", "k.", name) for name in content}
        about = json.loads(content["about"].tobytes())

    report = next(iter(about["report"].values()))
    parts = [about, *about["gestures"], *about["recognisers"], report]
    parts += [next(iter(report["curves"].values()))[0], report["left_out"][0]]
    keys = {key for part in parts for key in part}
    described = set(re.findall(r"`([^`]+)`", PAGE))
    assert arrays | keys <= described


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node.js to run the page's reader")
def test_the_reader_of_the_page_reads_a_model_and_asks_its_trees(file, model, tmp_path):
    script = tmp_path / "reader.mjs"
    code = re.search(r"```js\n(.*?)```", PAGE, re.DOTALL)[1]
    script.write_text(code + ASKED, encoding="utf-8")
    trees = model.recognisers[0]
    features = np.random.default_rng(0).normal(0, 1, feature_count(trees.channels))
    features = features.astype(np.float32)

    done = subprocess.run(
        ["node", str(script), str(file), json.dumps(features.tolist())],
        capture_output=True,
        check=True,
        timeout=30,
    )

    read = json.loads(done.stdout)
    with np.load(file, allow_pickle=False) as content:
        assert read["shapes"] == {name: list(content[name].shape) for name in content}
    assert read["names"] == list(model.names)
    expected = trees.scorer.trees.probabilities(features[None])[0, :-1]
    assert read["scores"] == pytest.approx(expected, abs=1e-5)
