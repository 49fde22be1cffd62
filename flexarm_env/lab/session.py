"""State of one browser tab: the arm, recordings, steps taken, and the current work."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import flexarm_env
from flexarm_env.arm import Arm
from flexarm_env.arm_text import arm_text
from flexarm_env.errors import InputError
from flexarm_env.identify.inspect.inspection import Inspection, inspect_recordings
from flexarm_env.identify.inspect.overview import overview
from flexarm_env.identify.replay.dataset import prepare
from flexarm_env.identify.results import NAMING, Addition, Diagnosis
from flexarm_env.lab.job import DONE, Job, Progress
from flexarm_env.lab.live import Live
from flexarm_env.lab.uploads import read_upload
from flexarm_env.pictures.inspection_page import inspection_page
from flexarm_env.recordings.recording import Recording
from flexarm_env.terminal.provenance import command_line, provenance
from flexarm_env.terminal.report import report

SEED, JOBS = 0, 2
INSPECTING = "Inspecting"
AS_GIVEN, REFITTED, BY_HAND = "as given", "constants refitted", "by hand"


@dataclass
class Session:
    """State of one tab.

    Attributes:
        base: the arm as given.
        arm: the arm after the last step.
        draft: the simulated arm: that after the last step, with effects and sizes set by hand.
        columns: a column map named on the command line.
        effects: effects of the user's own named there, as "FILE.py:Name".
        arm_named: the arm's file or name there; "" for the name of `base`.
        recordings: of the machine.
        live: the prepared recordings; None while there are none.
        inspection: facts on the recordings and their faults; None while there are none.
        steps: name and held-out error over the noise after each step.
        diagnosis: the last one; it is of the arm before its effects were added.
        job: the current work, or the last.
        added: whether the effects of the last diagnosis have been added.
        revision: count of messages from the current work; the page compares it to detect changes.
        dropped: whether it made room for another tab; its page then says so.
    """

    base: Arm
    columns: Path | None = None
    effects: Sequence[str] = ()
    arm_named: str = ""
    recordings: list[Recording] = field(default_factory=list)
    steps: list[tuple[str, float]] = field(default_factory=list)
    live: Live | None = None
    inspection: Inspection | None = None
    diagnosis: Diagnosis | None = None
    job: Job | None = None
    added: bool = False
    revision: int = 0
    dropped: bool = False

    def __post_init__(self) -> None:
        self.arm = self.draft = self.base

    @property
    def busy(self) -> bool:
        """Whether work is under way."""
        return self.job is not None and self.job.state == "running"

    def upload(self, files: Sequence[tuple[str, bytes]]) -> list[str]:
        """Read uploaded files, by name and content; return a line for each refused or noted one."""
        taken, lines = list(self.recordings), []
        for name, content in files:
            try:
                found = read_upload(self.base, name, content, self.columns, taken)
                prepare(self.base, [*taken, *found])
                taken += found
                lines += [f"{one.source}: {note}" for one in found for note in one.notes]
            except InputError as error:
                lines.append(str(error))
        if len(taken) > len(self.recordings):
            self.use(taken)
        return lines

    def use(self, recordings: list[Recording]) -> None:
        """Start over with these recordings.

        Raises:
            InputError: if they do not fit the arm.
        """
        # Pages read the session meanwhile: it changes only after all checks have passed.
        live = Live(self.base, recordings) if recordings else None
        steps = [] if live is None else [(AS_GIVEN, live.held_out(self.base).windows)]
        inspection = inspect_recordings(self.base, recordings) if recordings else None
        self.stop()
        self.recordings, self.live, self.steps, self.inspection = recordings, live, steps, inspection
        self.arm = self.draft = self.base
        self.diagnosis, self.job, self.added = None, None, False

    def change_arm(self, arm: Arm) -> None:
        """Start over with another arm and the same recordings.

        Raises:
            InputError: if they do not fit it.
        """
        old, self.base = self.base, arm
        try:
            self.use(self.recordings)
        except InputError:
            self.base = old
            raise
        self.arm_named = ""

    def tick(self, effect: str, on: bool) -> None:
        """Put an effect into the draft, at the size of the last step or its typical one, or remove it.

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
        """Start a diagnosis of the current arm."""
        recordings = self._ready()
        arm = self._commit_draft()
        self.diagnosis = None
        self._begin("Diagnosing", lambda progress: flexarm_env.diagnose(arm, recordings, progress=progress, seed=SEED, jobs=JOBS))

    def add(self, effect: str) -> None:
        """Add an effect: at once where the diagnosis accepted it alone, else by fitting it, which takes a while.

        Raises:
            InputError: for an effect that the arm has already or cannot have.
        """
        found = self.diagnosis
        if found is not None and found.effects == [effect] and self.can_adopt:
            self.adopt()
            return
        recordings = self._ready()
        self.draft.with_effect(effect)
        arm = self._commit_draft()
        self._begin(f"Adding {effect}", lambda progress: flexarm_env.add(effect, arm, recordings, progress=progress, seed=SEED))

    @property
    def can_adopt(self) -> bool:
        """Whether the last diagnosis found a better arm that is not adopted yet."""
        return self.diagnosis is not None and self.diagnosis.verdict in (*NAMING, "parameters") and not self.added

    def _commit_draft(self) -> Arm:
        """Record changes made by hand, if any, as a step; return the current arm."""
        if self.draft != self.arm and self.live is not None:
            self._step(BY_HAND, self.live.held_out(self.draft).windows)
            self.arm = self.draft
        return self.arm

    def adopt(self) -> None:
        """Adopt the diagnosis's final arm and its steps."""
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

    def write_inspection(self) -> None:
        """Start writing the page of what the recordings hold and can show."""
        recordings, base, inspection = self._ready(), self.base, self.inspection
        made = self._made("inspect", base, None)

        def work(progress: Progress) -> str:
            return inspection_page(overview(base, recordings, progress, inspection=inspection), made)

        self._begin(INSPECTING, work)

    def write_report(self) -> None:
        """Start writing the page of the last diagnosis, or of a comparison where there is none."""
        recordings, base, diagnosis = self._ready(), self.base, self.diagnosis
        nominal = base if diagnosis is None else diagnosis.nominal
        verb = "compare" if diagnosis is None else "diagnose"
        made = self._made(verb, nominal, None if diagnosis is None else SEED)

        def work(progress: Progress) -> str:
            progress(0.05, "comparing")
            return report(recordings, flexarm_env.compare(nominal, recordings), diagnosis, made, progress)

        self._begin("Writing the report", work)

    def _made(self, verb: str, arm: Arm, seed: int | None) -> dict[str, Any]:
        """Gather the facts by which a page can be made again on the command line."""
        files = [one.source or one.name for one in self.recordings]
        line = command_line(verb, files, self.arm_named or arm.name, self.columns, self.effects, seed)
        return {"command_line": line, **provenance("lab", arm.name, self.recordings, seed)}

    def poll(self) -> None:
        """Read the messages of the current work, and its result once it has ended."""
        if self.job is not None and self.job.poll():
            self.revision += 1
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
        """Stop the current work."""
        if self.job is not None:
            self.job.stop()

    def drop(self) -> None:
        """Stop the work and let go of the recordings, to make room for another tab."""
        self.use([])
        self.dropped = True

    def _ready(self) -> list[Recording]:
        if not self.recordings:
            raise InputError("there are no recordings; drop some CSV files in, or start with the demo")
        if self.busy:
            raise InputError("something is under way; wait for it or stop it")
        return list(self.recordings)

    def _begin(self, title: str, work: Callable[[Progress], Any]) -> None:
        self.job = Job(title, work)

    def arm_file(self) -> str:
        """Write the draft's arm file as text."""
        arm = self.draft
        if arm is not self.arm:  # intervals hold for fitted values only
            kept = {k: v for k, v in arm.fitted.items() if _has(arm, k) and arm.value(k) == v["value"]}
            arm = replace(arm, fitted=kept)
        return arm_text(arm)

    def next_run(self) -> str | None:
        """Write the proposed next run as CSV text of commands; None if there is no proposal."""
        found = self.diagnosis.next_run if self.diagnosis is not None else None
        return None if found is None else found.as_csv()


def _has(arm: Arm, path: str) -> bool:
    section, name, *_ = path.split(".")
    return section != "effects" or name in arm.effects
