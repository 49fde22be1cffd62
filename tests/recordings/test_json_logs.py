"""JSON logs: entries and conditions by paths, and how faults are refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording

MAP: dict[str, Any] = {
    "time": {"variable": "entries.t", "unit": "s"},
    "voltage": {"variable": "entries.u", "unit": "V"},
    "arm_angle": {"variable": "entries.q[1]", "unit": "deg"},
    "conditions": {"kp": {"variable": "gains.kp", "unit": "1"}, "enabled": {"variable": "entries.on", "unit": "1"}},
}


def log(**changes: Any) -> dict[str, Any]:
    entries = [{"t": k / 10, "u": float(k), "q": [0.0, 9.0 * k], "on": True} for k in range(6)]
    return {"gains": {"kp": 400}, "entries": entries, "motor": "small"} | changes


def written(tmp_path: Path, content: Any) -> Path:
    return save(tmp_path, json.dumps(content), "run.json")


def test_entries_and_conditions_are_read(tmp_path):
    run = Recording.read(written(tmp_path, log()), MAP)
    assert run.time.tolist() == pytest.approx(np.arange(6) / 10)
    assert run.signals["arm_angle"].tolist() == pytest.approx(np.radians(9.0 * np.arange(6)))
    assert run.conditions == {"kp": 400.0, "enabled": 1.0}


def test_objects_of_a_line_each_are_refused_with_a_remedy(tmp_path):
    path = tmp_path / "log.json"
    path.write_text('{"t": 0, "u": 1, "q": 0}\n{"t": 0.1, "u": 1, "q": 0}\n')
    assert refusal(path, columns=MAP).endswith("; write its objects as one list, [{…}, {…}]")


def test_a_list_of_entries_alone_is_read(tmp_path):
    places = {name: MAP[name] | {"variable": MAP[name]["variable"].removeprefix("entries.")} for name in list(MAP)[:3]}
    run = Recording.read(written(tmp_path, log()["entries"]), places)
    assert run.command.tolist() == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]


def test_lists_beside_each_other_are_read(tmp_path):
    content = {"t": [0.0, 0.1, 0.2], "u": [1, 2, 3], "q": [0.0, None, 2.0]}
    places = {
        name: {"variable": key, "unit": unit} for name, key, unit in zip(list(MAP)[:3], "tuq", ("s", "V", "rad"), strict=True)
    }
    run = Recording.read(written(tmp_path, content), places)
    assert np.isnan(run.signals["arm_angle"]).tolist() == [False, True, False]


def test_a_signal_may_be_absent_in_some_entries(tmp_path):
    content = log()
    del content["entries"][2]["q"]
    content["entries"][4] = {"t": 0.4, "u": 0.0, "on": True, "q": None}
    run = Recording.read(written(tmp_path, content), MAP)
    assert np.flatnonzero(np.isnan(run.signals["arm_angle"])).tolist() == [2, 4]


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("entries.p", "'entries.p' is in none of 6 entries; name another"),
        ("samples.q", "'samples.q' finds no 'samples' in an object with 'gains', 'entries', 'motor'"),
        ("entries.q", "'entries.q' leads to a list of 2 elements, counted from 0, not to a number"),
        ("entries.q[2]", "'entries.q[2]' finds no '[2]' in a list of 2 elements, counted from 0"),
        ("entries[9].q", "finds no '[9]' in a list of 6 elements"),
        ("motor", "'motor' leads to '\"small\"', not to a number"),
        ("entries..q", "'entries..q' is no path; write one such as 'entries.position'"),
        ("entries[0].t", "lengths differ"),
    ],
)
def test_a_path_that_leads_to_no_numbers_is_refused(tmp_path, path, words):
    assert words in refusal(written(tmp_path, log()), columns=MAP | {"arm_angle": {"variable": path, "unit": "rad"}})


@pytest.mark.parametrize("key", ["row", "index"])
def test_an_element_is_named_in_the_path_alone(tmp_path, key):
    entry = {"variable": "entries.q", "unit": "rad", key: 1}
    message = refusal(written(tmp_path, log()), columns=MAP | {"arm_angle": entry})
    assert "has 'row' or 'index' beside the variable of 'arm_angle'; write the element behind its name" in message
    assert "entries.q[0]" in message


def test_a_command_goes_on_where_an_entry_has_none(tmp_path):
    content = log()
    content["entries"][3]["u"] = None
    del content["entries"][4]["u"]
    run = Recording.read(written(tmp_path, content), MAP)
    assert run.command.tolist() == [0.0, 1.0, 2.0, 2.0, 2.0, 5.0]
    assert "'voltage' stands in 4 of 6 rows; in the others the last command holds" in run.notes
    content["entries"][0]["u"] = None
    assert "the first command stands in sample 2" in refusal(written(tmp_path, content), columns=MAP)


@pytest.mark.parametrize("absent", [True, False])
def test_time_is_needed_in_every_entry(tmp_path, absent):
    content = log()
    content["entries"][3]["t"] = None
    words = "leads to 'null', not to a number"
    if absent:
        del content["entries"][3]["t"]
        words = "finds no 't' in an object with 'u', 'q', 'on'"
    assert f"column 'time': 'entries.t' {words}" in refusal(written(tmp_path, content), columns=MAP)


@pytest.mark.parametrize(("name", "key"), [("time", "t"), ("voltage", "u"), ("arm_angle", "q")])
def test_true_and_false_are_numbers_of_a_condition_alone(tmp_path, name, key):
    content = log()
    content["entries"][3][key] = [0.0, True] if key == "q" else True
    message = refusal(written(tmp_path, content), columns=MAP)
    assert message == f"column '{name}': '{MAP[name]['variable']}' leads to 'true', not to a number"


def test_a_key_that_comes_twice_is_refused(tmp_path):
    text = json.dumps(log()).replace('"u": 3.0', '"u": 3.0, "t": 9')
    assert refusal(save(tmp_path, text, "run.json"), columns=MAP) == "an object has 't' twice; keep one of the two"


def test_two_quantities_of_one_variable_are_refused(tmp_path):
    table = MAP | {"arm_angle": MAP["voltage"] | {"unit": "rad"}}
    message = refusal(written(tmp_path, log()), columns=table)
    assert message == "columns 'voltage' and 'arm_angle': both map to 'entries.u'; correct one of them"


@pytest.mark.parametrize(("text", "what"), [("{},", "objects and lists"), ("0,", "values")])
def test_millions_of_parts_are_refused_before_they_are_read(tmp_path, monkeypatch, text, what):
    monkeypatch.setattr(json, "loads", lambda *_, **__: pytest.fail("is read"))
    content = "[" + text * (5_000_000 if what == "objects and lists" else 31_000_000) + "0]"
    assert f" {what}, the limit is " in refusal(save(tmp_path, content, "run.json"), columns=MAP)


def test_a_condition_that_changes_is_refused(tmp_path):
    content = log()
    content["entries"][3]["on"] = False
    message = refusal(written(tmp_path, content), columns=MAP)
    assert message.startswith("condition 'enabled': 'entries.on' is not one number throughout")


@pytest.mark.parametrize("content", [b"{", b"", b"[" * 100_000, b"\xff\xfe", b"{}", b"3", b"null", b'{"entries": {}}', b"[]"])
def test_other_content_is_refused(tmp_path, content):
    refusal(save(tmp_path, content, "run.json"), columns=MAP)


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.sampled_from("tuqon"), inner, max_size=4),
    max_leaves=12,
)


@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(VALUES, VALUES)
def test_any_json_is_read_or_refused(tmp_path, entries, kp):
    path = save(tmp_path, json.dumps({"entries": entries, "gains": {"kp": kp}}), "any.json")
    message = ""
    try:
        assert len(Recording.read(path, MAP)) > 1
    except InputError as error:
        message = str(error)
    assert message.startswith(f"{path}: ") or not message
    assert len(message.splitlines()) <= 1


def test_a_folder_of_logs_is_read_and_one_beside_other_recordings_is_not(tmp_path):
    for name in ("b", "a"):
        save(tmp_path, json.dumps(log()), f"{name}.json")
    assert [run.name for run in Recording.read_all(tmp_path, MAP)] == ["a", "b"]
    save(tmp_path, "time [s],voltage [V],arm_angle [rad]\n0,0,0\n1,0,0\n")
    assert [run.name for run in Recording.read_all(tmp_path)] == ["run"]


def test_logs_of_a_servo(measurements):
    columns = {
        "time": {"variable": "entries.timestamp", "unit": "s"},
        "voltage": {"variable": "entries.input_volts", "unit": "V"},
        "arm_angle": {"variable": "entries.position", "unit": "rad"},
        "conditions": {"kp": {"variable": "kp", "unit": "1"}, "mass": {"variable": "mass", "unit": "kg"}},
    }
    runs = Recording.read_all(measurements / "bam_xl330", columns)
    assert [run.conditions["kp"] for run in runs] == [100, 100, 200, 200, 400, 400, 800, 800]
    for run in runs:
        raw = json.loads(Path(run.source).read_text())
        assert run.conditions["mass"] == raw["mass"] == 0.49
        assert run.signals["arm_angle"].tolist() == [entry["position"] for entry in raw["entries"]]
