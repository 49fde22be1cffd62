"""Arms, recordings, comparisons and diagnoses show themselves in a notebook."""

from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace

import pytest
from picture_results import comparison, diagnosis, recordings

from flexarm_env import Arm
from flexarm_env.errors import InputError
from flexarm_env.identify.inspect.fault import Fault

RESULT = comparison(300, 0)
SHOWN = {
    "arm": (Arm.load("thesis-fem"), ["Arm thesis-fem", "gear_ratio", "coulomb_torque", "N·m"]),
    "recording": (recordings(RESULT)[0], ["Recording pulse: 300 samples", "motor speed", "current"]),
    "comparison": (RESULT, ["misses by 1.50 × the noise"]),
    "diagnosis": (diagnosis(), ["Missing: backlash", "0.0583 to 0.0641", "4.10", "gear_compliance"]),
}


@pytest.mark.parametrize("kind", SHOWN)
def test_each_has_a_table(kind):
    shown, words = SHOWN[kind]
    text = shown._repr_html_()
    for word in words:
        assert word in text
    assert text.count("<table>") == text.count("</table>") >= 1


@pytest.mark.parametrize("kind", SHOWN)
def test_each_has_a_figure(kind):
    go = pytest.importorskip("plotly.graph_objects")
    figure = SHOWN[kind][0].plot()
    assert isinstance(figure, go.Figure)
    assert len(figure.data) >= 2
    assert figure.layout.xaxis.title.text or figure.layout.annotations


@pytest.mark.parametrize(
    ("kind", "line"),
    [
        ("arm", r"Arm\('thesis-fem', current drive, effects: .*coulomb.*\)"),
        ("recording", r"Recording\('pulse': 300 samples, .*\)"),
        (
            "comparison",
            r"Comparison\('thesis' against pulse, square, sweep: error 1.5 of the noise in windows, 12 in free runs\)",
        ),
        ("diagnosis", r"Diagnosis\(effects: backlash, error [0-9.]+ -> [0-9.]+ of the noise\)"),
    ],
)
def test_each_is_one_line_at_a_prompt(kind, line):
    assert re.fullmatch(line, repr(SHOWN[kind][0]))


def test_a_diagnosis_of_faulty_recordings_names_the_faults_at_a_prompt():
    fault = Fault("run", "run.csv", "arm_angle", "sign", None, "", "the angle's sign is turned", "")
    found = replace(diagnosis(), verdict="recordings", effects=[], recordings=[fault])
    assert repr(found) == "Diagnosis(recordings: sign)"


def test_names_are_no_markup():
    (one, *_) = recordings(RESULT)
    object.__setattr__(one, "name", "<script>")
    assert "<script>" not in one._repr_html_()


def test_a_figure_without_plotly_is_one_line(monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    with pytest.raises(InputError, match=r"pip install 'flexarm-env\[plots\]'"):
        Arm.load("thesis").plot()


def test_tables_need_no_plotly():
    program = "import sys; sys.modules['plotly'] = None; from flexarm_env import Arm; print(Arm.load('thesis')._repr_html_())"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "bending_stiffness" in run.stdout
