"""A search with Optuna that goes on after a stop as if there had been none."""

from __future__ import annotations

import json
import math
import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from flexarm_env.errors import InputError
from flexarm_env.tuning.spaces import Range

#: Trials at random before the sampler models what they have shown.
RANDOM_TRIALS = 15
#: Largest first line of a journal that is read [bytes].
LONGEST_LINE = 10_000
#: Between the seeds of two searches, more than any has trials.
SEEDS_EACH = 1_000_003

Values = Mapping[str, float]


class Study:
    """Trials of values within ranges, and their scores; in a journal file they outlast the process.

    The values of trial k follow from the seed, k, and the scores before: a search that is stopped and continued ends with the
    same values, bit for bit. Searches that share a journal under one name share their trials, too.

    Args:
        name: of the study in its journal.
        space: ranges by name.
        journal: file; None keeps the trials in memory.

    Raises:
        InputError: where Optuna is not installed, or the journal is none.
    """

    def __init__(self, name: str, space: Mapping[str, Range], journal: Path | None = None) -> None:
        try:
            import optuna
        except ImportError:
            raise InputError('a search needs Optuna; pip install "flexarm-env[control]"') from None
        self._optuna = optuna
        optuna.logging.set_verbosity(optuna.logging.ERROR)
        self.space = {
            key: optuna.distributions.FloatDistribution(each.low, each.high, log=each.logarithmic) for key, each in space.items()
        }
        if journal is not None and not journal.parent.is_dir():
            raise InputError(f"{journal}: there is no folder {journal.parent}; make it first")
        try:
            storage = _storage(journal)
            self._study = optuna.create_study(study_name=name, storage=storage, load_if_exists=True, direction="minimize")
            sound = all(map(self._is_sound, self.finished()))
        except Exception:  # Optuna lets through whatever it meets in a damaged file
            sound = False
        if not sound:
            raise InputError(f"{journal}: is no journal of a search, or a damaged one; name another file, or a new one")

    def run(
        self,
        trials: int,
        seed: int,
        objective: Callable[[Values], float],
        first: Values | None = None,
        report: Callable[[int, float], None] | None = None,
    ) -> None:
        """Go on until there are as many trials.

        Args:
            trials: in all.
            seed: of the values.
            objective: computes the score of values, less is better.
            first: values of the first trial; random ones by default.
            report: is called after each trial with their number and the least score.
        """
        states, create = self._optuna.trial.TrialState, self._optuna.trial.create_trial
        while (done := len(self.finished())) < trials:
            if done == 0 and first is not None:
                made = create(params=dict(first), distributions=self.space, value=objective(first))
                self._study.add_trial(made)
            else:
                sampler = self._optuna.samplers.TPESampler(
                    seed=(SEEDS_EACH * seed + done) % 2**32, n_startup_trials=RANDOM_TRIALS
                )
                self._study.sampler = sampler
                trial = self._study.ask(self.space)
                try:
                    self._study.tell(trial, objective(trial.params))
                except BaseException:
                    self._study.tell(trial, state=states.FAIL)
                    raise
            if report is not None:
                report(done + 1, self.best()[1])

    def finished(self) -> list[Any]:
        """List the trials that have a score."""
        complete = self._optuna.trial.TrialState.COMPLETE
        found: list[Any] = self._study.get_trials(deepcopy=False, states=(complete,))
        return found

    def _is_sound(self, trial: Any) -> bool:
        """Whether a trial has a score and values of this search."""
        known = trial.params.keys() == self.space.keys()
        return known and all(map(math.isfinite, (trial.value, *trial.params.values())))

    def best(self) -> tuple[dict[str, float], float]:
        """Find the values of the least score, and that score."""
        least = min(self.finished(), key=lambda trial: trial.value)
        return dict(least.params), float(least.value)


def _storage(journal: Path | None) -> Any:
    if journal is None:
        return None
    from optuna.storages import JournalStorage
    from optuna.storages.journal import JournalFileBackend, JournalFileSymlinkLock

    if journal.exists() and (not journal.is_file() or not _begins_as_journal(journal)):
        raise ValueError  # before Optuna adds a line to it
    lock = JournalFileSymlinkLock(str(journal))
    if journal.exists():
        lock.acquire()  # another process that shares the journal may be within a line
        try:
            _drop_unfinished_line(journal)
        finally:
            lock.release()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # experimental, to Optuna
        return JournalStorage(JournalFileBackend(str(journal), lock))


def _begins_as_journal(path: Path) -> bool:
    with path.open("rb") as file:
        line = file.readline(LONGEST_LINE)
    try:
        return not line or "op_code" in json.loads(line)
    except (ValueError, TypeError, RecursionError):
        return False


def _drop_unfinished_line(journal: Path) -> None:
    """Cut off a last line that a killed process left unfinished, to which Optuna would add the next one."""
    content = journal.read_bytes()
    whole = content.rfind(b"\n") + 1
    if whole != len(content):
        os.truncate(journal, whole)
