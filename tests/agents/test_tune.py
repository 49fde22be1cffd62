"""The search for better options, in a storage that others share."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("stable_baselines3")
pytest.importorskip("optuna")

from agents.learning.options import Plan
from agents.learning.plan_file import read_table
from agents.tune import JUDGES_COUNT, JUDGES_SEED, RANGES, changed, main

TINY = "actions = 20\nat_once = 2\n[network]\nlayers = [4]\n[learning]\nbatch_size = 20\n[interface]\nrepeat = 100\n"


def test_what_is_searched_are_options_and_within_their_bounds() -> None:
    for values in ({path: low for path, (low, _) in RANGES.items()}, {path: high for path, (_, high) in RANGES.items()}):
        table = changed(Plan(), values).table()
        assert all(table[path.split(".")[0]][path.split(".")[1]] == value for path, value in values.items())
    assert changed(Plan(), {}) == read_table({})


def test_the_judging_arms_are_nobody_else_s() -> None:
    from agents.learning.episodes import SEEDS_EACH
    from flexarm_env.trials.sets import FIRST_SEED

    assert JUDGES_SEED + JUDGES_COUNT <= FIRST_SEED
    assert 50 * SEEDS_EACH < JUDGES_SEED  # of dozens of training seeds none comes there


@pytest.mark.slow
def test_a_search_goes_on_where_another_stopped(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "tiny.toml").write_text(TINY)
    command = [str(tmp_path / "tiny.toml"), "--storage", str(tmp_path / "search.journal"), "--trials", "2", "--actions", "20"]
    assert main(command) == 0
    assert main(command) == 0
    assert "best of 4" in capsys.readouterr().out


def test_a_bad_storage_is_refused_in_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "tiny.toml").write_text(TINY)
    assert main([str(tmp_path / "tiny.toml"), "--storage", str(tmp_path / "none" / "a.journal")]) == 2
    error = capsys.readouterr().err
    assert "no folder" in error
    assert error.count("\n") == 1
