"""Scenes: sources, changes, errors, pickling."""

import pickle

import corpuscle as cp
import numpy as np
import pytest


def test_every_built_in_scene_is_read():
    names = cp.scenes()
    assert len(names) > 20
    assert {cp.Scene(name).model for name in names} == {"gas", "dew", "flood"}


def test_a_file_a_text_and_a_name_give_the_same_scene(tmp_path):
    named = cp.Scene("gas/maxwell")
    path = tmp_path / "own.toml"
    path.write_text(named.toml)
    assert cp.Scene(path) == cp.Scene(named.toml) == named


def test_changes_are_values_of_python_and_numpy():
    changes = {"gas.species.0.count": np.int64(12), "gas.follow": 0, "gas.size": np.array([100.0, 50.0]), "gas.walls.x_min": "periodic"}
    scene = cp.Scene("gas/maxwell", **changes, **{"gas.walls.x_max": "periodic"})
    assert "count = 12" in scene.toml and "size = [100.0, 50.0]" in scene.toml and 'x_min = "periodic"' in scene.toml
    table = scene.changed(**{"gas.method": {"fixed-step": {"time_step_s": 0.02}}})
    assert "time_step_s = 0.02" in table.toml
    assert "time_step_s" not in scene.toml


def test_a_scene_survives_pickling():
    scene = cp.Scene("flood/valley", **{"flood.manning": 0.04})
    assert pickle.loads(pickle.dumps(scene)) == scene


def test_a_wrong_key_is_named_with_what_to_do():
    with pytest.raises(cp.SceneError, match="did you mean `manning`") as caught:
        cp.Scene("flood/valley", **{"flood.maning": 0.04})
    assert caught.value.key == "flood.maning"


def test_the_line_of_a_mistake_is_told():
    text = cp.Scene("gas/maxwell").toml.replace("radius = 4.0", "radius = -4.0")
    number = next(number for number, line in enumerate(text.splitlines(), 1) if "radius = -4.0" in line)
    with pytest.raises(ValueError) as caught:
        cp.Scene(text)
    assert (caught.value.key, caught.value.line) == ("gas.species.0.radius", number)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.key, again.line, str(again)) == (caught.value.key, number, str(caught.value))


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (float("nan"), "no finite number"),
        (float("inf"), "no finite number"),
        (np.array([1.0, np.nan]), "no finite number"),
        (object(), "object cannot be written"),
        ({1, 2}, "set cannot be written"),
    ],
)
def test_values_that_a_scene_cannot_hold_are_refused(value, words):
    with pytest.raises(cp.SceneError, match=f"gas.size.*{words}"):
        cp.Scene("gas/maxwell", **{"gas.size": value})


def test_an_unknown_scene_gets_a_proposal():
    with pytest.raises(cp.SceneError, match="did you mean flood/valley"):
        cp.Scene("flood/valey")
