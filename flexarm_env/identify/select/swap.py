"""Rivals of an accepted effect: one takes its place where it fits better beside everything else."""

from __future__ import annotations

from dataclasses import dataclass, replace

from flexarm_env.identify.calibrate.calibrator import Calibrator
from flexarm_env.identify.progress import Progress
from flexarm_env.identify.select.choose import with_forecasts
from flexarm_env.identify.select.criteria import Criteria, Measure
from flexarm_env.identify.select.fits import fit_in_place
from flexarm_env.identify.select.model import Model, judge
from flexarm_env.identify.select.rivals import is_simpler_and_as_good, spread
from flexarm_env.identify.select.starts import candidates, rivals_of, shows_part_of_period, simpler_beyond
from flexarm_env.identify.select.trace import Accepted, Trace, Tried, others_of, placed, with_last_score


@dataclass(frozen=True)
class RivalComparison:
    """An effect compared with its rivals, each beside everything else that was accepted.

    Attributes:
        effect: the one that fits best.
        best: the model with it.
        alike: models with others that leave as little, by effect.
        tried: all effects that were compared, those that cannot be rivals among them.
        untried: rivals for which no time was left.
    """

    effect: str
    best: Model
    alike: dict[str, Model]
    tried: frozenset[str]
    untried: tuple[str, ...] = ()


def compare_rivals(
    calibrator: Calibrator,
    criteria: Criteria,
    accepted: Accepted,
    now: Model,
    progress: Progress,
    compared: frozenset[str] = frozenset(),
) -> RivalComparison:
    """Compare an effect of a model with the rival that fits best, and with the best of those of fewer numbers.

    A rival of more numbers that fits as well does not stand before a simpler one.

    Args:
        calibrator: of the recordings.
        criteria: of the search.
        accepted: one of the effects of the model, compared with those that it is confused with and its equivalents so far.
        now: the model with everything that was accepted.
        progress: of these calibrations.
        compared: rivals that are left out, as they were compared before.
    """
    effect, dataset = accepted.effect, calibrator.dataset
    without = now.arm.without_effect(effect)
    smooth = shows_part_of_period(now.arm, effect, dataset)
    every = rivals_of(effect, without, dataset) + (simpler_beyond(effect, without, dataset) if smooth else [])
    others = {*accepted.equivalent[1:], *accepted.near} - {effect, *every}
    every += [name for name in candidates(without, dataset) if name in others]
    names = [name for name in every if name not in compared]
    near = now.score.windows <= calibrator.settings.errors.explained
    own_values = now.arm.effects[effect]
    fitted = fit_in_place(calibrator, without, names, progress, own_values, thorough=smooth, rivals_of_noise=near)
    tried, untried = frozenset([effect, *names[: len(fitted)]]), tuple(names[len(fitted) :])
    rivals = [m for m in fitted if m and not m.at_bound]
    if not rivals:
        return RivalComparison(effect, now, {}, tried, untried)
    own = replace(now, effects=(effect,))
    measure = criteria.measure([own.score, *(m.score for m in rivals)])
    own, *rivals = with_forecasts(calibrator, criteria, [own, *rivals], own.score)
    rank = criteria.rank(own.score, measure, dataset)
    rivals.sort(key=rank)
    rivals[0] = _polish_near(calibrator, rivals[0], own)
    simpler = [m for m in rivals[1:] if m.numbers < own.numbers]
    best = own
    for rival in (rivals[0], *simpler[:1]):
        if _takes_place(calibrator, criteria, rival, best, measure):
            best = rival
    level = criteria.equivalence_level(best.score, measure)
    alike = {m.effects[0]: m for m in (own, *rivals) if m is not best and measure(m.score) <= level}
    return RivalComparison(best.effects[0], best, alike, tried, untried)


def exchange(trace: Trace, place: int, comparison: RivalComparison) -> Trace:
    """Put the effect that fits best in a place, with all that the recordings cannot tell from it."""
    name, now, ranking = comparison.effect, trace.accepted[place], trace.ranking
    gain = max((ranking[n].gain for n in (name, now.effect) if n in ranking), default=0.0)
    models = {name: comparison.best, **comparison.alike}
    tried = [Tried(n, ranking[n].gain if n in ranking else gain, m.calibration) for n, m in models.items()]
    untried = [n for n in now.equivalent if n not in comparison.tried]
    equivalent = (name, *comparison.alike, *untried)
    entry = replace(now, equivalent=equivalent, beside=others_of([a.effect for a in trace.accepted], place))
    if name == now.effect:
        return trace.then("swap", accepted=placed(trace.accepted, place, entry), tried=tried)
    tried.append(Tried(name, gain, comparison.best.calibration))
    accepted = placed(trace.accepted, place, replace(entry, effect=name))
    return trace.then("swap", comparison.best, with_last_score(accepted, comparison.best), tried)


def _takes_place(calibrator: Calibrator, criteria: Criteria, rival: Model, now: Model, measure: Measure) -> bool:
    """Whether a rival fits better than the effect of a model, is simpler and as good, or as good where that ran to its bound."""
    one, other, alike_to = _on_all_data(calibrator, rival, now)
    same = calibrator.settings.errors.same
    if criteria.replaces(one, other, measure, calibrator.dataset) and not is_simpler_and_as_good(other, one, alike_to, same):
        return True
    if is_simpler_and_as_good(one, other, alike_to, same):
        return measure(one.score) <= criteria.equivalence_level(other.score, measure)
    return now.at_bound and measure(rival.score) <= criteria.equivalence_level(now.score, measure)


def _on_all_data(calibrator: Calibrator, rival: Model, now: Model) -> tuple[Model, Model, float]:
    """Calibrate both models on all of the data where both are close to the noise, as the criterion that ranks them there assumes.

    What was held out may hold the motion that tells them apart; without it, the right one may only be the less certain one. Where
    errors are rough, that calibration may end worse than the one before it: the better of both stands for a model.

    Returns:
        Rival, model, and the ratio of errors up to which they are equally good.
    """
    converged = calibrator.settings.errors.converged
    if max(rival.score.windows, now.score.windows) >= calibrator.settings.errors.close:
        return rival, now, converged
    with calibrator.workers.threads():
        again = [calibrator.calibrate_on_all_data(model.calibration) for model in (rival, now)]
    found = [judge(m.effects, calibration, calibrator.dataset) for m, calibration in zip((rival, now), again, strict=True)]
    one, other = (min(pair, key=lambda m: m.bic(calibrator.dataset)) for pair in zip((rival, now), found, strict=True))
    return one, other, max(converged, spread(now, found[1]))


def _polish_near(calibrator: Calibrator, rival: Model, now: Model) -> Model:
    """Continue the calibration of a rival, unless the model is nearer by so much that it has no chance."""
    errors, left, rest = calibrator.settings.errors, now.score.windows, rival.score.windows
    if (left <= errors.near and rest >= errors.close) or (left <= errors.close and rest >= errors.far_off):
        return rival
    with calibrator.workers.threads():
        polished = judge(rival.effects, calibrator.polish(rival.calibration), calibrator.dataset)
    return rival if polished.at_bound else polished
