"""What one person at one browser tab has: an arm, recordings, steps taken, and the work under way."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.arm_file import arm_text
from flexarm_env.errors import InputError
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.results import Addition, Diagnosis
from flexarm_env.lab.job import DONE, Job, Progress
from flexarm_env.lab.live import Live
from flexarm_env.lab.uploads import read_upload
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.provenance import provenance
from flexarm_env.terminal.report import report

SEED, JOBS = 0, 2
AS_GIVEN, REFITTED, BY_HAND = "as given", "constants refitted", "by hand"


@dataclass
class Session:
    """State of one tab.

    Attributes:
        base: the arm as it came.
        arm: the arm of the last step.
        draft: the arm that is simulated: that of the last step, with effects ticked and sizes dragged by hand.
        columns: a column map named on the command line.
        recordings: of the machine.
        live: the recordings made ready; None while there are none.
        steps: name and held-out error over the noise after each step.
        diagnosis: the last one; of the arm before what it found was added.
        job: the work under way, or what ended last.
        added: whether what the last diagnosis found has been added.
        news: how often the work under way has said something; pages that show the session compare it.
    """

    base: Arm
    columns: Path | None = None
    recordings: list[Recording] = field(default_factory=list)
    steps: list[tuple[str, float]] = field(default_factory=list)
    live: Live | None = None
    diagnosis: Diagnosis | None = None
    job: Job | None = None
    added: bool = False
    news: int = 0

    def __post_init__(self) -> None:
        self.arm = self.draft = self.base

    @property
    def busy(self) -> bool:
        """Whether work is under way."""
        return self.job is not None and self.job.state == "running"

    def upload(self, files: Sequence[tuple[str, bytes]]) -> list[str]:
        """Take in uploaded files, by name and content; return a line for each that is not taken or that is to be noted."""
        taken, lines = list(self.recordings), []
        for name, content in files:
            try:
                found = read_upload(self.base, name, content, self.columns, taken)
                prepare(self.base, [*taken, found])
                taken.append(found)
                lines += [f"{found.source}: {note}" for note in found.notes]
            except InputError as error:
                lines.append(str(error))
        if len(taken) > len(self.recordings):
            self.use(taken)
        return lines

    def use(self, recordings: list[Recording]) -> None:
        """Begin again with these recordings.

        Raises:
            InputError: if they do not fit the arm.
        """
        # Pages look at the session while this works: nothing changes before all is known.
        live = Live(self.base, recordings) if recordings else None
        steps = [] if live is None else [(AS_GIVEN, live.held_out(self.base).windows)]
        self.stop()
        self.recordings, self.live, self.steps = recordings, live, steps
        self.arm = self.draft = self.base
        self.diagnosis, self.job, self.added = None, None, False

    def change_arm(self, arm: Arm) -> None:
        """Begin again with another arm and the same recordings.

        Raises:
            InputError: if they do not fit it.
        """
        old, self.base = self.base, arm
        try:
            self.use(self.recordings)
        except InputError:
            self.base = old
            raise

    def tick(self, effect: str, on: bool) -> None:
        """Put an effect into the draft, as the last step had it or at its typical size, or take it out.

        Raises:
            InputError: if the arm cannot have it.
        """
        if on:
            self.draft = self.draft.with_effect(effect, **self._usual(effect))
        else:
            self.draft = self.draft.without_effect(effect)

    def _usual(self, effect: str) -> dict[str, float]:
        if effect in self.arm.effects:
            return dict(self.arm.effects[effect])
        scales = {} if self.live is None else self.live.data.scales
        known = self.draft.known[effect].parameters
        sizes = {key: p.typical * p.scaled_by(scales) for key, p in known.items()}
        return {key: min(max(value, known[key].low), known[key].high) for key, value in sizes.items()}

    def drag(self, effect: str, parameter: str, value: float) -> None:
        """Set a parameter of an effect in the draft.

        Raises:
            InputError: for a value out of bounds.
        """
        self.draft = self.draft.with_effect(effect, **{parameter: value})

    def diagnose(self) -> None:
        """Begin to diagnose the arm as it is now."""
        recordings = self._ready()
        arm = self._settle()
        self.diagnosis = None
        self._begin("Diagnosing", lambda say: flexarm_env.diagnose(arm, recordings, progress=say, seed=SEED, jobs=JOBS))

    def add(self, effect: str) -> None:
        """Add an effect: at once where it is all that the diagnosis accepted, else by fitting it, which takes a while.

        Raises:
            InputError: for an effect that the arm has already or cannot have.
        """
        found = self.diagnosis
        if found is not None and found.effects == [effect] and self.can_adopt:
            self.adopt()
            return
        recordings = self._ready()
        self.draft.with_effect(effect)
        arm = self._settle()
        self._begin(f"Adding {effect}", lambda say: flexarm_env.add(effect, arm, recordings, progress=say, seed=SEED))

    @property
    def can_adopt(self) -> bool:
        """Whether the last diagnosis found an arm that is better and not taken over yet."""
        return self.diagnosis is not None and self.diagnosis.verdict in ("effects", "parameters") and not self.added

    def _settle(self) -> Arm:
        """Make a step of what was ticked and dragged by hand, if anything; return the arm as it is now."""
        if self.draft != self.arm and self.live is not None:
            self._step(BY_HAND, self.live.held_out(self.draft).windows)
            self.arm = self.draft
        return self.arm

    def adopt(self) -> None:
        """Take over the arm that the diagnosis ended with, and its steps."""
        found = self.diagnosis
        if found is None or not self.can_adopt:
            raise InputError("there is nothing to add: diagnose first")
        names = {f"+ {name}": found.error[name] for name in found.effects if name in found.error}
        self._step(REFITTED, found.error["refitted"])
        for name, error in names.items():
            self._step(name, error)
        if found.effects:
            self.steps[-1] = (self.steps[-1][0], found.error["final"])
        self.arm = self.draft = found.arm
        self.added = True

    def _step(self, name: str, error: float) -> None:
        self.steps = [*self.steps, (name, error)]

    def write_report(self) -> None:
        """Begin to make the page of the last diagnosis, or of a comparison where there is none."""
        recordings, base, diagnosis = self._ready(), self.base, self.diagnosis
        nominal = base if diagnosis is None else diagnosis.nominal
        verb = "compare" if diagnosis is None else "diagnose"
        line = ["flexarm", verb, *(one.source or one.name for one in recordings), "--arm", nominal.name]
        seed = None if diagnosis is None else SEED
        made: dict[str, Any] = {"command_line": shlex.join(line + ([] if seed is None else ["--seed", str(seed)]))}
        made |= provenance("lab", nominal.name, recordings, seed)

        def work(say: Progress) -> str:
            say(0.05, "comparing")
            return report(recordings, flexarm_env.compare(nominal, recordings), diagnosis, made, say)

        self._begin("Writing the report", work)

    def poll(self) -> None:
        """Take in what the work under way has said, and what it found once it has ended."""
        if self.job is not None and self.job.poll():
            self.news += 1
            if self.job.state == DONE:
                self._finish(self.job.result)

    def _finish(self, result: Any) -> None:
        if isinstance(result, Diagnosis):
            self.diagnosis, self.added = result, False
        elif isinstance(result, Addition):
            if self.steps[-1][0] in (AS_GIVEN, BY_HAND):
                self._step(REFITTED, result.error["refitted"])
            self._step(f"+ {result.effect}", result.error["final"])
            self.arm = self.draft = result.arm
            self.added = True

    def stop(self) -> None:
        """Stop the work under way."""
        if self.job is not None:
            self.job.stop()

    def _ready(self) -> list[Recording]:
        if not self.recordings:
            raise InputError("there are no recordings; drop some CSV files in, or start with the demo")
        if self.busy:
            raise InputError("something is under way; wait for it or stop it")
        return list(self.recordings)

    def _begin(self, title: str, work: Callable[[Progress], Any]) -> None:
        self.job = Job(title, work)

    def arm_file(self) -> str:
        """Return the text of the draft's arm file."""
        arm = self.draft
        if arm is not self.arm:  # intervals hold for fitted values only
            kept = {k: v for k, v in arm.fitted.items() if _has(arm, k) and arm.value(k) == v["value"]}
            arm = replace(arm, fitted=kept)
        return arm_text(arm)

    def next_run(self) -> str | None:
        """Return the proposed next run as a CSV file of commands, None if there is no proposal."""
        found = self.diagnosis.next_run if self.diagnosis is not None else None
        return None if found is None else found.as_csv()


def _has(arm: Arm, path: str) -> bool:
    section, name, *_ = path.split(".")
    return section != "effects" or name in arm.effects
