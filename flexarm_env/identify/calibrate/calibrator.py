"""How an arm is calibrated: from observer-corrected replays to free ones, so that no local minimum holds it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from flexarm_env.arm import Arm
from flexarm_env.identify.calibrate.calibration import Calibration
from flexarm_env.identify.calibrate.least_squares import Ending, Solution, minimise
from flexarm_env.identify.calibrate.objective import objective_at
from flexarm_env.identify.calibrate.parameters import free_parameters
from flexarm_env.identify.calibrate.refine import refine
from flexarm_env.identify.calibrate.schedule import Schedule
from flexarm_env.identify.replay.dataset import Dataset
from flexarm_env.identify.replay.error_measure import Score, score
from flexarm_env.identify.replay.hold_out import hold_out_late
from flexarm_env.identify.replay.scales import torque_scale
from flexarm_env.identify.settings import Settings
from flexarm_env.identify.workers import Workers


@dataclass(frozen=True)
class Calibrator:
    """Calibrates arms against one dataset, with priors centred on one nominal arm.

    Attributes:
        nominal: the arm before any calibration.
        dataset: the recordings.
        workers: processes and threads of its fits.
    """

    nominal: Arm
    dataset: Dataset
    workers: Workers = field(default_factory=Workers)

    @property
    def settings(self) -> Settings:
        """Numbers of the method."""
        return self.dataset.settings

    def score(self, arm: Arm, held_out: bool = True) -> Score:
        """Measure the errors of an arm on the held-out or the fitted part."""
        return score(arm, self.dataset, held_out)

    def calibrate(self, arm: Arm, levels: Sequence[float] | None = None) -> Calibration:
        """Calibrate everything free in an arm through levels of process noise, then at its own torque noise.

        Args:
            arm: where to start.
            levels: over the rms torque of the drive; the usual ones if left out.
        """
        numbers = self.settings.calibrating
        levels = self.settings.process_noise.calibration if levels is None else levels
        return self._run_schedule(arm, levels, numbers.passes, numbers.iterations)

    def calibrate_rival(self, arm: Arm, thorough: bool = False) -> Calibration | None:
        """Calibrate an arm that would have to leave only noise; None as soon as more than `errors.close` is left.

        Under observers a model that lacks nothing leaves only noise wherever it starts, so the first levels show which one does.

        Args:
            arm: where to start.
            thorough: whether to start from the nominal constants as well, with more feedback: constants that made up for another
                effect, or that compensate each other, have no way back under less.
        """
        numbers, noise, most = self.settings.calibrating, self.settings.process_noise, self.settings.errors.close
        again = ((self.nominal_with_effects_of(arm), noise.calibration_more),) if thorough else ()
        for start, levels in ((arm, noise.calibration), *again):
            found = self._schedule(start, numbers.iterations).run(self._noises(start, levels), numbers.passes, most)
            if found is not None:
                return self.restart_from_nominal(found) if thorough else found
        return None

    def calibrate_briefly(self, arm: Arm) -> tuple[float, Calibration]:
        """Calibrate an arm in a few steps; also give its error in windows on the fitted part."""
        found = self._run_schedule(arm, self.settings.process_noise.brief, 0, self.settings.calibrating.brief_iterations)
        return self.score(found.arm, held_out=False).windows, found

    def uncalibrated(self, arm: Arm) -> Calibration:
        """Present an arm as a calibration in which nothing moved."""
        parameters = free_parameters(arm, arm, self.dataset)
        x = parameters.position(arm)
        steps = parameters.step_sizes(x, self.settings.parameters)
        solution = Solution(x, np.inf, np.zeros(0), np.zeros((0, len(x))), steps)
        return Calibration(arm, solution, objective_at(arm, self.dataset, parameters, arm.constants["drive"]["torque_noise"]))

    def calibrate_constants(self) -> Calibration:
        """Calibrate the nominal constants; only at the arm's own torque noise where more feedback gains nothing.

        Where little is left, constants that hardly matter are scanned. They all stay as given where calibrated ones are worse on
        the held-out part: these make up for something else.
        """
        before = self.score(self.nominal, held_out=False)
        found, after = self.calibrate_by_best_schedule(self.nominal)
        if after.windows > before.windows:
            found = self.calibrate(self.nominal, levels=())
        else:
            found = self._scan_weak(found, after)
        is_worse = self.score(found.arm).windows > self.score(self.nominal).windows
        return self.uncalibrated(self.nominal) if is_worse else found

    def choose_hold_out(self) -> tuple[Calibrator, Calibration]:
        """Hold out less where the calibrated constants show a missing effect that appears late in the recordings.

        Returns:
            A calibrator of the dataset so held out, and its calibration of the constants.
        """
        found = self.calibrate_constants()
        settled = self.settle(found)
        if settled is not found:
            return self, settled
        later = self.hold_out_late(found.arm)
        return (self, found) if later is self else (later, later.calibrate_constants())

    def hold_out_late(self, arm: Arm) -> Calibrator:
        """Make a calibrator that sees more of the recordings where a calibrated arm fails late; itself where it does not."""
        later = hold_out_late(arm, self.dataset)
        return self if later is self.dataset else replace(self, dataset=later)

    def settle(self, found: Calibration) -> Calibration:
        """Calibrate on all of the data where the fitted part leaves constants uncertain; keep it where the model is to blame.

        Constants that explain what they were fitted to, and not the rest, may be uncertain. Then some explain both.
        """
        most = self.settings.errors.nothing_left
        if self.score(found.arm).windows <= most or self.score(found.arm, held_out=False).windows > most:
            return found
        again, left = self._continue_on_all_data(found)
        if left > most:
            start = found if len(found.solution.jacobian) else again  # the slopes show what is weak
            again, left = self._continue_on_all_data(self._with_weak_scanned(start, self._error_on_all_data))
        return again if left <= most else found

    def _continue_on_all_data(self, found: Calibration) -> tuple[Calibration, float]:
        """Continue a calibration on all of the data as long as that lowers the error, which it returns, too.

        Where constants compensate each other on the fitted part, the rest leads out of a long valley.
        """
        left = np.inf
        for _ in range(1 + self.settings.calibrating.continuations):
            again = self.calibrate_on_all_data(found)
            now = self._error_on_all_data(again.arm)
            if now >= left / self.settings.errors.converged:
                break
            found, left = again, now
            if left <= self.settings.errors.nothing_left:
                break
        return found, left

    def _scan_weak(self, found: Calibration, now: Score) -> Calibration:
        """Scan what hardly matters on the fitted part where little is left, and continue from there if that is better."""
        errors = self.settings.errors
        if not errors.nothing_left < now.windows <= errors.close:
            return found
        scanned = self._with_weak_scanned(found, self._fitted_error)
        other = found if scanned.arm == found.arm else self.calibrate(scanned.arm, levels=())
        return other if self.score(other.arm, held_out=False).is_better_than(now) else found

    def _with_weak_scanned(self, found: Calibration, error: Callable[[Arm], float]) -> Calibration:
        """Set each constant that changes the fitted part by less than the noise to where an error is least.

        Where an arm rarely sticks, the error is a step in the static friction: no slope leads there.
        """
        numbers, x, apply = self.settings.calibrating, found.solution.x, found.parameters.apply
        shares = np.arange(-1.0, 1.0 + numbers.scan_step, numbers.scan_step)
        j, priors = found.solution.jacobian, found.parameters.priors
        changes = numbers.weak * priors * np.linalg.norm(j, axis=0) / np.sqrt(len(j))
        for along in np.diag(priors)[changes < 1.0]:
            values = [x, *(np.where(along > 0.0, share * along, x) for share in shares)]
            x = min(values, key=lambda value: error(apply(found.arm, value)))
        return replace(found, arm=apply(found.arm, x), solution=replace(found.solution, x=x))

    def _fitted_error(self, arm: Arm) -> float:
        """Measure the error in windows of the fitted part."""
        return self.score(arm, held_out=False).windows

    def _error_on_all_data(self, arm: Arm) -> float:
        """Measure the error in windows of the fitted or of the held-out part, the larger one."""
        return max(self.score(arm, held_out).windows for held_out in (False, True))

    def calibrate_by_best_schedule(self, arm: Arm) -> tuple[Calibration, Score]:
        """Calibrate from an arm; also give the errors on the fitted part.

        A model that ends off, but not so far that something must be missing, may have constants that compensate each other. With
        more feedback at first they do not. The better of both calibrations is chosen.
        """
        found = self.calibrate(arm)
        after = self.score(found.arm, held_out=False)
        if not self.settings.errors.close < after.windows < self.settings.errors.far_off:
            return found, after
        other = self.calibrate(arm, self.settings.process_noise.calibration_more)
        then = self.score(other.arm, held_out=False)
        return (other, then) if then.windows < after.windows else (found, after)

    def restart_from_nominal(self, found: Calibration) -> Calibration:
        """Choose the better of a calibration and another that starts from the nominal constants with its effects.

        Constants that compensated for a missing effect may have moved to where there is no way back.
        """
        now = self.score(found.arm, held_out=False)
        if now.windows < self.settings.errors.calibrated:
            return found
        other, then = self.calibrate_by_best_schedule(self.nominal_with_effects_of(found.arm))
        return other if then.is_better_than(now) else found

    def polish(self, found: Calibration) -> Calibration:
        """Continue a calibration as far as it goes, from where it ended or from the nominal constants.

        Where the model stays far off, the error is so rough that one more calibration may halve it. Where little is left, as with
        backlash, one more may end at the noise.
        """
        errors, process_noise = self.settings.errors, self.settings.process_noise
        found = self.restart_from_nominal(found)
        now = self.score(found.arm, held_out=False)
        near = errors.near < now.windows < errors.close
        again = (process_noise.calibration,) * self.settings.calibrating.continuations
        for levels in (process_noise.calibration, process_noise.calibration_last) if near else again:
            if not near and now.windows < errors.far_off:
                break
            other = self.calibrate(found.arm, levels)
            then = self.score(other.arm, held_out=False)
            if then.is_better_than(now) and not self._is_worse_held_out(other, found):
                found, now = other, then
            elif not near:
                break
        scanned = self._scan_weak(found, now)
        return found if self._is_worse_held_out(scanned, found) else scanned

    def _is_worse_held_out(self, other: Calibration, found: Calibration) -> bool:
        """Whether a continued calibration is worse on the held-out part, as where rough errors of the fitted one lead it."""
        return self.score(other.arm).windows > self.settings.errors.converged * self.score(found.arm).windows

    def calibrate_on_all_data(self, found: Calibration) -> Calibration:
        """Continue a calibration on all of the data and refine it: the final result, once no choice of model is left.

        Where errors are rough, as those of a gap, or an effect is missing, it may end worse. Then the constants stay, and are
        as uncertain as the two ends are apart.
        """
        numbers, parameters = self.settings.calibrating, found.parameters
        objective = objective_at(found.arm, self.dataset.nothing_held_out(), parameters, found.objective.torque_noise)
        objective = objective.weighted_by(found.arm, narrow_priors=False)
        x, prior = parameters.position(found.arm), objective.weights.prior
        is_close = objective.excess_factor <= self.settings.errors.close  # and will be refined
        iterations = 1 if is_close else numbers.last_iterations
        steps, ending = found.solution.steps, Ending(iterations, numbers.final_tolerance)
        solution = minimise(objective.residuals, x, prior, steps, self.settings.least_squares, ending)
        refined = refine(objective, solution.x)
        at = replace(solution, x=refined.x, residual=refined.residual)
        again = Calibration(parameters.apply(found.arm, refined.x), at, objective, narrow=refined.jacobian)
        shift = np.sqrt(again.unexplained) * (solution.x - x)
        again = replace(again, moved=np.hypot(shift, refined.scatter))
        before, after = (self._error_on_all_data(arm) for arm in (found.arm, again.arm))
        errors, worse = self.settings.errors, 1.0 + self.settings.selecting.noticed
        if after <= errors.explained or (before > errors.explained and after <= worse * before):
            return again
        stayed = replace(solution, x=x, residual=objective.residual(x))
        return replace(again, arm=found.arm, solution=stayed, moved=np.hypot(refined.x - x, refined.scatter))

    def finish(self, found: Calibration) -> Calibration:
        """Calibrate on all of the data for good, once a model was chosen.

        Where it is far off, errors are so rough that a calibration ends near where it began. It is continued as long as that
        lowers the error, from the nominal constants as well; the better end stands, as uncertain as the others are away.
        """
        if self._error_on_all_data(found.arm) <= self.settings.errors.far_off:
            return self.calibrate_on_all_data(found)
        starts = (found, self.calibrate(self.nominal_with_effects_of(found.arm)))
        ends = [self._continue_on_all_data(start) for start in starts]
        best = min(ends, key=lambda end: end[1])[0]
        others = [best.parameters.position(arm) for arm in (found.arm, *(end.arm for end, _ in ends))]
        apart = np.abs(np.array(others) - best.solution.x).max(axis=0)
        return replace(best, moved=np.hypot(0.0 if best.moved is None else best.moved, apart))

    def nominal_with_effects_of(self, arm: Arm) -> Arm:
        """Give the nominal arm the effects that another has beside its own."""
        added = {name: arm.effects[name] for name in arm.effects if name not in self.nominal.effects}
        return replace(self.nominal, effects={**self.nominal.effects, **added})

    def reset_biased_constants(self, found: Calibration, most: float) -> Arm:
        """Reset to nominal the constants that moved by more than some standard deviations of their priors.

        Where none did, all of them: so little may compensate for an effect, too, and right values are near.
        """
        moved = [(p, abs(x) / p.prior) for p, x in found.parameters.pairs(found.solution.x) if p.is_constant]
        far = [p.path for p, deviations in moved if deviations > most] or [p.path for p, _ in moved]
        return found.arm.with_values({path: self.nominal.value(path) for path in far})

    def _run_schedule(self, arm: Arm, levels: Sequence[float], passes: int, iterations: int) -> Calibration:
        """Calibrate through levels of process noise, over the rms torque of the drive, and in passes at the arm's own."""
        noises = self._noises(arm, levels)
        found = self._schedule(arm, iterations).run(noises, passes if noises else max(passes, 1))
        assert found is not None  # however much it leaves
        return found

    def _noises(self, arm: Arm, levels: Sequence[float]) -> list[float]:
        """Convert levels of process noise, over the rms torque of the drive, to those [Nm] above an arm's own."""
        scale, own = torque_scale(arm, self.dataset.runs), arm.constants["drive"]["torque_noise"]
        return [level * scale for level in levels if level * scale > own]

    def _schedule(self, arm: Arm, iterations: int) -> Schedule:
        return Schedule(arm, self.dataset, free_parameters(arm, self.nominal, self.dataset), iterations)
