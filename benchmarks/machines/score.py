"""The benchmark's table: the share of right answers, against the goals."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence

from benchmarks.answers.figures import Answer, Figure, calibration, coverage, median, share
from benchmarks.hidden_effects.score import believed, is_right, is_right_or_twin, merge_twins, verdict_in
from benchmarks.hidden_effects.truth import holds
from benchmarks.machines.method import FAILED

#: Kinds with one effect that the catalogue holds; verdicts that are wrong where nothing is missing.
SINGLE, ALARMS = ("one", "sensor"), ("effects", "partly", "unknown", "recordings", FAILED)


def with_twins_named_as_hidden(answer: Answer) -> Answer:
    """Name each hidden effect where one was found that moves the machine alike in its recordings."""
    twins = answer["case"]["twins"]
    return answer | {"found": answer["found"] | {"effects": [twins.get(name, name) for name in answer["found"]["effects"]]}}


def is_honest(answer: Answer) -> bool:
    """Whether all hidden effects are named, or their exact twins, and no other; or some of them, with the verdict `partly`."""
    answer = with_twins_named_as_hidden(answer)
    named, hidden = (merge_twins(answer[part]["effects"]) for part in ("found", "case"))
    if named == hidden:
        return True
    return bool(named) and named < hidden and answer["found"]["verdict"] == "partly"


def is_solved(answer: Answer) -> bool:
    """Whether the answer is right by the goal of its kind."""
    kind = answer["case"]["kind"]
    if kind in SINGLE:
        return is_right_or_twin(with_twins_named_as_hidden(answer))
    if kind == "null":
        return not verdict_in(*ALARMS)(answer)
    return verdict_in("unknown", "partly")(answer) if kind == "outside" else is_honest(answer)


def intervals(answer: Answer) -> Iterator[tuple[str, bool]]:
    """Yield every constant and every parameter of a hidden effect that was found, and whether its interval contains the truth.

    The true parameters of hidden effects count as one kind, "parameters of effects".
    """
    truth, found = answer["case"]["truth"], answer["found"]
    for name, interval in found["constants"].items():
        if name in truth:
            yield name, holds(interval, truth[name])
    for candidate in found["ranking"]:
        for key, interval in candidate["parameters"].items() if candidate["accepted"] else ():
            path = f"{candidate['effect']}.{key}"
            if path in truth:
                yield "parameters of effects", holds(interval, truth[path])


def figures(answers: Sequence[Answer]) -> list[Figure]:
    """Compute the lines of the table."""

    def of(*kinds: str) -> list[Answer]:
        return [answer for answer in answers if answer["case"]["kind"] in kinds]

    held: dict[str, list[bool]] = defaultdict(list)
    for answer in of(*SINGLE, "two", "three", "null"):
        for name, inside in intervals(answer):
            held[name].append(inside)
    return [
        share("right effect or its exact twin first", 0.97, of(*SINGLE), is_solved),
        share("right effect first", 0.97, of(*SINGLE), is_right),
        share("right effect or its exact twin first, sensors only", 0.97, of("sensor"), is_solved),
        share("two effects: both, or `partly` and none false", 0.85, of("two"), is_honest),
        share("three effects: all, or `partly` and none false", 0.8, of("three"), is_honest),
        share("outside the catalogue: `unknown` or `partly`", 0.9, of("outside"), verdict_in("unknown", "partly")),
        share("false alarm on nulls", 0.01, of("null"), verdict_in(*ALARMS), at_most=True),
        *(coverage(f"90 % intervals that hold the truth, {name}", (0.85, 0.95), held[name]) for name in sorted(held)),
        calibration("probability of named effects, expected calibration error", 0.05, believed(answers)),
        median("time of one core, median", "≤ 120 s", [a["cpu_seconds"] for a in answers], lambda v: v <= 120.0, "s"),
    ]
