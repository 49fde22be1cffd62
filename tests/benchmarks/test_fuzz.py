"""A thousand damaged files of all kinds, and that a reader at fault is found."""

from __future__ import annotations

import time
import warnings
from collections import Counter
from pathlib import Path

import pytest

from benchmarks.fuzz import attempt as trial
from benchmarks.fuzz.attempt import READ, READERS, REFUSED, attempt, damaged, warm_up
from benchmarks.fuzz.corpus import corpus
from flexarm_env import InputError

SEED, FILES = 0, 1000


def test_sound_files_are_read(tmp_path):
    warm_up(tmp_path)
    assert all(corpus()[kind] for kind in ("recording", "arm", "columns"))
    assert {sound.suffix for sound in corpus()["recording"]} >= {".csv", ".txt", ".lvm", ".mat"}


def test_a_number_makes_the_same_file_again():
    assert [damaged(4, number)[1] for number in range(50)] == [damaged(4, number)[1] for number in range(50)]
    assert damaged(4, 0)[1] != damaged(5, 0)[1]


@pytest.mark.slow(minutes=0.5)
def test_a_thousand_damaged_files_are_read_or_refused_in_one_line(tmp_path):
    warm_up(tmp_path)
    outcomes = [attempt(SEED, number, tmp_path) for number in range(FILES)]
    assert [outcome for outcome in outcomes if outcome.is_find] == []
    counts = Counter((outcome.kind, outcome.what) for outcome in outcomes)
    for kind in ("recording", "arm", "columns"):
        assert min(counts[kind, READ], counts[kind, REFUSED]) > 10, counts


def too_long(path, sound):
    raise InputError("a word " * 1000)


def fault(path, sound):
    raise KeyError("t")


def warning(path, sound):
    warnings.warn("overflow", RuntimeWarning, stacklevel=1)


def hang(path, sound):
    while True:
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("reader", "words"),
    [(too_long, "no line for a person"), (fault, "KeyError: 't'"), (warning, "RuntimeWarning: overflow"), (hang, "hung")],
)
def test_a_reader_at_fault_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reader, words):
    monkeypatch.setattr(trial, "LONGEST", 0.2)
    outcome = attempt(SEED, 0, tmp_path, dict.fromkeys(READERS, reader))
    assert outcome.is_find
    assert words in outcome.what


@pytest.mark.parametrize(("most_before", "most_after", "what"), [(1e8, 2e9, "took 1900 MB"), (2.1e9, 2.2e9, READ)])
def test_a_gigabyte_beyond_what_the_process_has_had_is_found(tmp_path, monkeypatch, most_before, most_after, what):
    memory = iter([most_before, most_after])
    monkeypatch.setattr(trial, "_memory", lambda: next(memory))
    assert attempt(SEED, 0, tmp_path, dict.fromkeys(READERS, lambda path, sound: None)).what == what
