"""Conditions in remarks are read however headers and spreadsheets write them, and none is lost without a word."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from recording_files import GOOD, refusal, save
from work import ends

from flexarm_env.recordings.recording import Recording


@pytest.mark.parametrize(
    "remark",
    [
        "payload 0.3 kg",
        "payload [kg] 0.3",
        "Payload: 0.3 kg",
        "PAYLOAD = 0.3 kg",
        "payloads: 0.3 kg",
        "payloads = 0.3 kg",
        "payload is 0.3 kg",
        "payload -> 0.3 kg (steel)",
        "tip payload = 0.3 kg",
        "the payload: 0,3 kg",
        "payload 300 g",
        "payload 0.3",
        "start 5 s",
        "payload, kg = 0.3",
        "payload/kg = 0.3",
        "payload,0.3,kg",
        "payload;0.3 kg",
        "payload;0,3;kg;;",
        "payload (steel) 300 g",
    ],
)
def test_a_condition_in_other_words_is_not_lost(tmp_path: Path, remark: str) -> None:
    message = refusal(save(tmp_path, f"# {remark}\n{GOOD}"))
    assert message.startswith("row 1: ")
    assert "did you mean" in message


@pytest.mark.parametrize(
    "remark",
    [
        "payload removed",
        "start of run: 5 s",
        "no payload",
        "started 12:30",
        "Start: 2017-04-27",
        "state: 3",
        "rate: 500 Hz",
        "payload 2 of 3",
        "payload, steel",
        "payload/arm ratio = 3",
        "start (of the run) by hand",
    ],
)
def test_other_remarks_are_let_be(tmp_path: Path, remark: str) -> None:
    assert Recording.read(save(tmp_path, f"# {remark}\n{GOOD}")).conditions == {}


@pytest.mark.parametrize(
    ("remark", "found"),
    [
        ("payload (kg) = 0.3", {"payload": 0.3}),
        ("payload (g): 300", {"payload": 0.3}),
        ("payload = 0.3 kg,,,", {"payload": 0.3}),
        ("rotor = 0.02 kg m^2,,,,,", {"rotor": 0.02}),
        ("kp = 400;;", {"kp": 400.0}),
        ("kp [1] = 400", {"kp": 400.0}),
        ("kp (V/deg) = 2", {"kp": pytest.approx(360.0 / np.pi)}),
    ],
)
def test_a_condition_as_headers_and_spreadsheets_write_it(tmp_path: Path, remark: str, found: dict[str, float]) -> None:
    run = Recording.read(save(tmp_path, f"# {remark}\n{GOOD}"))
    assert run.conditions == found
    assert run.notes == ()


@pytest.mark.parametrize(
    ("remark", "meant"),
    [
        ("Payload mass: 0.3 kg", "'# payload = 0.3 kg'"),
        ("payload weight = 0.3 kg", "'# payload = 0.3 kg'"),
        ("payload mass [kg]: 0.3", "'# payload = 0.3 kg'"),
        ("payload_mass = 0.3 kg", "'payload'"),
        ("payload (at tip): 0.3 kg", "'# payload = 0.3 kg'"),
    ],
)
def test_a_payload_in_more_words_is_not_lost(tmp_path: Path, remark: str, meant: str) -> None:
    assert meant in refusal(save(tmp_path, f"# {remark}\n{GOOD}"))


@pytest.mark.parametrize("remark", ["payload mass: see log", "payload massive: 3 kg", "payload weight: heavy"])
def test_prose_about_a_payload_is_a_remark(tmp_path: Path, remark: str) -> None:
    assert Recording.read(save(tmp_path, f"# {remark}\n{GOOD}")).conditions == {}


def test_a_name_that_is_no_word_costs_no_comparison(tmp_path: Path) -> None:
    with ends():
        assert Recording.read(save(tmp_path, f"# {'payload' * 3_000_000} = 3\n{GOOD}")).conditions


def test_the_hint_can_be_copied(tmp_path: Path) -> None:
    message = refusal(save(tmp_path, f"# payload 0,3 kg\n{GOOD}"))
    assert message.endswith("did you mean '# payload = 0.3 kg'?")
    assert Recording.read(save(tmp_path, f"# payload = 0.3 kg\n{GOOD}")).conditions == {"payload": 0.3}


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("# res = 4.2 ohmm", "row 1: 'res = 4.2 ohmm' is read as a remark: unknown unit 'ohmm'"),
        ("# kp = 6 V/radd", "unknown unit 'V/radd'"),
        ("# rotor = 30 gcm2", "'rotor = 30 gcm2' is read as a remark: unknown unit 'gcm2'"),
        ("# rotor = 0,02 kg m^2", "'rotor = 0,02 kg m^2' is read as a remark: it has a decimal comma; write a point"),
        ("# kp = 0,3", "'kp = 0,3' is read as a remark: it has a decimal comma; write a point"),
        ('# kp = "400"', "is read as a remark: write a number, with or without a unit, and nothing else"),
        ("# kp = 400 # of the drive", "is read as a remark: write a number, with or without a unit, and nothing else"),
        ("# kp = 4e", "unknown unit 'e'"),
        ("# rotor = 30 g cm^2", ""),
        ("# kp = 6", ""),
        ("# day = 2024-05-01", ""),
        ("# at = 10:30", ""),
        ("# part = 3 of 12 runs", ""),
        ("# made = 1/2/2024", ""),
        ("# rig: no. 5", ""),
    ],
)
def test_a_condition_of_an_unknown_unit_is_noted(tmp_path, line, words):
    (tmp_path / "run.csv").write_text(f"{line}\n{GOOD}")
    notes = Recording.read(tmp_path / "run.csv").notes
    assert words in notes[0] if words else notes == ()


@pytest.mark.parametrize(
    "remark",
    [
        "kp = 3, payload = 0.3 kg",
        "run 5 | payload = 0.3 kg",
        "arm A; payload: 300 g",
        "the tip payload was about 0.3 kg",
        "payload ~ 0,3 kg",
        "PAYLOAD: 0.3 KG",
        "payload kg = 0.3",
    ],
)
def test_a_payload_amid_other_words_is_noted(tmp_path: Path, remark: str) -> None:
    run = Recording.read(save(tmp_path, f"# {remark}\n{GOOD}"))
    assert "payload" not in run.conditions
    (note,) = run.notes
    assert note.startswith(f"row 1: '{remark}' is read as a remark: write '# payload = 0.3 kg' in a line of its own")
