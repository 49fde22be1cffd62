"""The benchmark's table: the share of right answers, against the goals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable

from benchmarks.answers.figures import Answer, Figure, coverage, first, median, share
from benchmarks.hidden_effects.truth import covered

SENSORS = (
    "tach_filter",
    "tach_ripple",
    "strain_drift",
    "strain_lag",
    "pot_nonlinearity",
    "sensor_offset",
    "time_offset",
    "crosstalk",
    "gage_creep",
)
#: Effects with the same motion under current drive, between which no method does better than chance.
TWINS = {"time_offset": "input_delay", "brush_drop": "dead_zone"}


def merge_twins(effects: Iterable[str]) -> set[str]:
    """Map effects to names that are common to twins."""
    return {TWINS.get(effect, effect) for effect in effects}


def is_right(answer: Answer) -> bool:
    """Whether the first effect named is the hidden one."""
    return first(answer) == answer["case"]["effects"][0]


def is_right_or_twin(answer: Answer) -> bool:
    """Whether the first effect named is the hidden one, or its twin."""
    return merge_twins(answer["found"]["effects"][:1]) == merge_twins(answer["case"]["effects"][:1])


def is_in_class(answer: Answer) -> bool:
    """Whether the hidden effect is among at most two that the diagnosis cannot distinguish."""
    classes = answer["found"]["equivalent"]
    return is_right(answer) or (bool(classes) and len(classes[0]) <= 2 and answer["case"]["effects"][0] in classes[0])


def is_in_first_three(answer: Answer) -> bool:
    """Whether the hidden effect is among the first three of the ranking."""
    return answer["case"]["effects"][0] in [c["effect"] for c in answer["found"]["ranking"][:3]]


def both_right(answer: Answer) -> bool:
    """Whether exactly the hidden effects are named."""
    return set(answer["found"]["effects"]) == set(answer["case"]["effects"])


def both_right_or_twins(answer: Answer) -> bool:
    """Whether exactly the hidden effects are named, or their twins."""
    return merge_twins(answer["found"]["effects"]) == merge_twins(answer["case"]["effects"])


def right_side(answer: Answer) -> bool:
    """Whether a sensor's fault is diagnosed as one, and any other effect is not."""
    named = first(answer)
    return named is not None and (named in SENSORS) == (answer["case"]["effects"][0] in SENSORS)


def _is_late(answer: Answer) -> bool:
    """Whether the hidden effect is a delay: no recording shows whether it lies in the sensor or in the drive."""
    return "input_delay" in merge_twins(answer["case"]["effects"][:1])


def verdict_in(*verdicts: str) -> Callable[[Answer], bool]:
    """Build the predicate that an answer has one of some verdicts."""
    return lambda answer: answer["found"]["verdict"] in verdicts


def removed(answer: Answer) -> float:
    """Compute the share of the excess held-out error that the corrected arm removes."""
    error = answer["found"]["error"]
    before, after = (max(error[key] ** 2 - 1.0, 0.0) for key in ("refitted", "final"))
    return 1.0 - after / before if before > 0.0 else 0.0


def believed(answers: Iterable[Answer]) -> list[tuple[float, bool]]:
    """List the probability of every named effect, and whether the machine has it or its exact twin."""
    found = []
    for answer in answers:
        hidden = merge_twins(answer["case"]["effects"])
        for name, every in zip(answer["found"]["effects"], answer["found"]["probability"], strict=True):
            found.append((every[0], merge_twins([name]) <= hidden))
    return found


def figures(answers: Iterable[Answer]) -> list[Figure]:
    """Compute the lines of the table."""
    every = list(answers)

    def of(kind: str, *strengths: float) -> list[Answer]:
        return [a for a in every if a["case"]["kind"] == kind and (not strengths or a["case"]["strength"] in strengths)]

    sided = [a for a in of("one", 3.0, 10.0) if first(a)]
    solved = [a for a in of("one", 3.0, 10.0) if is_right(a)]
    held = [holds for a in every if a["case"]["kind"] != "outside" for _, holds in covered(a["case"], a["found"])]
    return [
        share("right effect first, strength 3", 0.9, of("one", 3.0), is_right),
        share("right effect or its exact twin first, strength 3", 0.9, of("one", 3.0), is_right_or_twin),
        share("right effect first, strength 10", 0.97, of("one", 10.0), is_right),
        share("right class of at most two, strength 3", 0.97, of("one", 3.0), is_in_class),
        share("right effect first, strength 1", 0.7, of("one", 1.0), is_right),
        share("in the first three, strength 1", 0.9, of("one", 1.0), is_in_first_three),
        share("two effects, both right, strength 3", 0.8, of("two", 3.0), both_right),
        share("two effects, both right or exact twins, strength 3", 0.8, of("two", 3.0), both_right_or_twins),
        share("false alarm on nulls", 0.02, of("null"), verdict_in("effects", "partly", "unknown"), at_most=True),
        share("outside the catalogue: flagged", 0.85, of("outside"), verdict_in("unknown", "partly")),
        share("outside the catalogue: mislabelled", 0.1, of("outside"), verdict_in("effects"), at_most=True),
        share("sensor against plant side", 0.97, sided, right_side),
        share("sensor against plant side, without exact twins", 0.97, [a for a in sided if not _is_late(a)], right_side),
        coverage("90 % intervals that hold the truth", (0.87, 0.93), held),
        median("excess held-out error removed, median", "≥ 90 %", [removed(a) for a in solved], lambda v: v >= 0.9, "%"),
        median("final held-out error, median", "≤ 1.05", [a["found"]["error"]["final"] for a in solved], lambda v: v <= 1.05, ""),
        median(
            "time of one core for three recordings, median",
            "≤ 120 s",
            [a["cpu_seconds"] for a in every],
            lambda v: v <= 120.0,
            "s",
        ),
    ]


def confusions(answers: Iterable[Answer]) -> list[tuple[str, str, int]]:
    """Count the confusions of single effects: hidden effect, effect named in its place, number of cases."""
    counts: Counter[tuple[str, str]] = Counter()
    for answer in answers:
        if answer["case"]["kind"] == "one" and not is_right(answer):
            found = answer["found"]
            counts[answer["case"]["effects"][0], ", ".join(found["effects"]) or found["verdict"]] += 1
    return [(hidden, named, n) for (hidden, named), n in counts.most_common()]
