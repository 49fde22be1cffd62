"""The documents' tables are those of the results; `python tests/test_docs_numbers.py` writes them anew.

A table stands between two comments that name it.
"""

from __future__ import annotations

import json
import re
import statistics
import sys
import textwrap
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import pytest
from documents import PROJECT, README

from benchmarks.answers.figures import Figure
from benchmarks.hidden_effects.score import figures

RESULTS = PROJECT / "results"
HIDDEN = RESULTS / "hidden_effects" / "diagnose-8"
MACHINES = RESULTS / "machines" / "seed-892338"
SETTINGS_OF_PROBABILITIES = PROJECT / "flexarm_env" / "identify" / "settings" / "explaining.py"
SERVOS = RESULTS / "elastic_joint" / "seed-414678"


def demo_table(numbers: str) -> str:
    """Write README.md's part on the demo from the numbers in results/demo/demo.json."""
    from flexarm_env.demo.story import HIDDEN
    from flexarm_env.pictures.words import number

    results = json.loads(numbers)
    diagnosis, added = results["diagnose"], results["add"]
    steps = {
        "model as given": "nominal",
        "constants refitted": "refitted",
        f"`{added['effect']}` added, all refitted": "final",
    }
    rows = [f"| {name} | {number(added['error'][k])} | {number(added['free_run'][k])} |" for name, k in steps.items()]
    effect, key, size, unit = HIDDEN
    found = f"The verdict is `{diagnosis['verdict']}`: {', '.join(diagnosis['effects']) or 'none named'}."
    hidden = f"The hidden effect was {effect} with a {size} {unit} {key}"
    if added["effect"] == effect:
        value = added["parameters"][key]
        low, high = (number(value[end], 4) for end in ("low", "high"))
        hidden += f"; the estimate is {number(value['value'], 4)} {unit} (90 % interval {low} to {high})"
    lines = [
        "| held-out error over noise | windows of 1 s | one free run |",
        "|---|---:|---:|",
        *rows,
        "",
        f"{found} The diagnosis took {number(diagnosis['seconds'], 2)} s in two processes.",
        f"{hidden}.",
    ]
    return "\n".join(lines) + "\n"


def baselines_table(numbers: str) -> str:
    """Write README.md's table of the baselines from the numbers in results/baselines/baselines.json."""
    from agents.report import summary_of

    result = json.loads(numbers)
    words = (
        f"The slew over 100°, means over {result['arms']} arms: as in the file (nominal), or with up to 0.3 kg at the tip\n"
        "and constants that differ (randomised). An arm that never settles counts with 5 s."
    )
    return f"{words}\n\n{summary_of(result)}"


def hidden_effects_words(numbers: str) -> str:
    """Write README.md's part on the benchmark of hidden effects from the numbers in its table.json."""
    results = json.loads(numbers)
    share = {figure["what"]: f"{100.0 * figure['value']:.0f} %" for figure in results["figures"]}
    one, two = share["right effect first, strength 3"], share["two effects, both right, strength 3"]
    like_one = share["right effect or its exact twin first, strength 3"]
    like_two = share["two effects, both right or exact twins, strength 3"]
    words = (
        f"[The benchmark](docs/hidden-effects.md) has {results['cases']} machines of that simulator, with hidden effects or none."
        f" `diagnose` names the right effect first in {one} of those where it causes an error of three times the noise, and both"
        f" of two effects in {two} ({like_one} and {like_two} if effects with the same motion count as one). The false-alarm"
        f" rate is {share['false alarm on nulls']}, and {share['outside the catalogue: flagged']} of the effects from outside"
        " the catalogue are reported as unknown."
    )
    filled = textwrap.fill(words.replace(" %", "\xa0%"), 124, break_long_words=False, break_on_hyphens=False)
    return filled.replace("\xa0", " ") + "\n"


def hidden_effects_table(written: str) -> str:
    """A benchmark's table, without its heading."""
    return written.split("\n", 2)[2]


def methods_table(numbers: str) -> str:
    """Tabulate the methods' figures side by side: the first, of the given numbers, on BIC's sample as well."""
    sampled = [(HIDDEN / "answers" / answer.name).read_text() for answer in HIDDEN.with_name("bic-8").glob("answers/*.json")]
    same = figures([json.loads(answer) for answer in sampled])
    results = [json.loads(numbers), {"method": "diagnose", "cases": f"the {len(sampled)}", "figures": [asdict(f) for f in same]}]
    results += [json.loads((HIDDEN.with_name(f"{name}-8") / "table.json").read_text()) for name in ("best-fit", "bic", "sindy")]
    lines = [
        "| | goal | " + " | ".join(f"`{r['method']}`, {r['cases']} cases" for r in results) + " |",
        "|---|---|" + "---:|" * len(results),
    ]
    for row in zip(*(r["figures"] for r in results), strict=True):
        texts = [Figure(**figure).text for figure in row]
        lines.append(f"| {row[0]['what']} | {row[0]['goal']} | {' | '.join(texts)} |")
    return "\n".join(lines) + "\n"


def times_words(numbers: str) -> str:
    """Write the times of one core for a case of the benchmark, from the answers of the table with the given numbers."""
    answers = [json.loads(answer.read_text()) for answer in (HIDDEN / "answers").glob("*.json")]
    assert len(answers) == json.loads(numbers)["cases"]
    none, one, two = (
        statistics.median(a["cpu_seconds"] for a in answers if len(a["case"]["effects"]) == count) for count in range(3)
    )
    longest = max(a["cpu_seconds"] for a in answers) / 60.0
    return (
        f"One core takes {none:.0f} s for a case with nothing hidden, {one:.0f} s with one effect, {two:.0f} s with two\n"
        f"(medians), and {longest:.0f} minutes at most.\n"
    )


def tuned_table(_: str) -> str:
    """Tabulate the shipped tuned controllers: score and margins, before and after."""
    from flexarm_env.arm import Arm
    from flexarm_env.controllers.tuned import shipped_controllers
    from flexarm_env.tuning.search import measured_margins

    def three(margins) -> list[str]:
        if not margins:
            return ["none"] * 3
        return [f"{margins['gain']:.2f}", f"{margins['phase']:.0f}", f"{1e3 * margins['delay']:.1f}"]

    lines = [
        "| law | score: own | tuned | gain × : own | tuned | phase [°]: own | tuned | dead time [ms]: own | tuned |",
        "|---|" + "---:|" * 8,
    ]
    for each in shipped_controllers().values():
        before = three(measured_margins(each.controller, Arm.load(each.arm), {}))
        pairs = [cell for pair in zip(before, three(each.margins), strict=True) for cell in pair]
        scores = [f"{each.search[key]:.2f}" for key in ("score_before", "score")]
        lines.append(f"| `{each.controller}` | " + " | ".join([*scores, *pairs]) + " |")
    return "\n".join(lines) + "\n"


def probabilities_words(_: str) -> str:
    """Say the probabilities of named effects, in the words of the document on the verdicts."""
    from flexarm_env.identify.settings import SETTINGS

    chances = SETTINGS.probabilities
    explained, mostly, partly, first, little = (
        f"{100.0 * share:.0f} %" for share in (chances.explained, chances.mostly, chances.partly, chances.first, chances.little)
    )
    words = (
        f"`probability` says how often such answers were right on machines whose effects are known: {explained} where only noise "
        f"is left, {mostly} where {little} of the excess is left at most, and {partly} where more is. Equivalent effects share "
        f"it; the first of them has {first} of it. Machines of [the benchmark](machines.md) that decided nothing measure how "
        "true that is."
    )
    return textwrap.fill(words, 128) + "\n"


def robustness_table(numbers: str) -> str:
    """Tabulate the share of arms that do not settle, and the mean settling time, for the tuned laws and the policies."""
    result = json.loads(numbers)
    shown = [name for name in result["cells"]["randomised"] if name.endswith("_tuned") or name in result["policies"]]
    lines = [
        f"{result['arms']} arms in each set, seed {result['seed']}: arms that do not settle [%], mean settling time [s].",
        "",
        "| | " + " | ".join(result["cells"]) + " |",
        "|---|" + "---:|" * len(result["cells"]),
    ]
    for name in shown:
        cells = [each[name] for each in result["cells"].values()]
        texts = [f"{c['unsettled']['mean']['value']:.0f}, {c['settling_time']['mean']['value']:.2f}" for c in cells]
        runs = f", n = {cells[0]['runs']}" if name in result["policies"] else ""
        lines.append(f"| `{name}`{runs} | " + " | ".join(texts) + " |")
    return "\n".join(lines) + "\n"


def rigs_tables(numbers: str) -> str:
    """Write the gallery of real rigs from its answers."""
    from flexarm_env.rigs.document import document

    return document(json.loads(numbers)["rigs"], "../results/rigs/")


def versions_table(numbers: str) -> str:
    """Write the table of the runs on the oldest and newest versions."""
    from benchmarks.versions.table import markdown

    return markdown(json.loads(numbers))


def endurance_words(numbers: str) -> str:
    """Write what came of the endurance run."""
    from benchmarks.endurance.table import words

    return words(json.loads(numbers))


def scale_out_words(numbers: str) -> str:
    """Write how much faster two workers of a cluster are than one."""
    from benchmarks.scale_out import words

    return words(json.loads(numbers))


def lines_words(numbers: str) -> str:
    """Write the share of lines that tests execute."""
    from benchmarks.lines import words

    return words(json.loads(numbers))


def lines_with(first: str) -> Callable[[str], str]:
    """Make a function that takes the table with this beginning from a report in Markdown."""

    def taken(report: str) -> str:
        (table,) = (part for part in report.split("\n\n") if part.startswith(first))
        return table + "\n"

    return taken


@dataclass(frozen=True)
class Table:
    """A table of a document: its name in the comments, the file of its numbers, and the function that writes it."""

    name: str
    document: Path
    numbers: Path
    make: Callable[[str], str]

    @property
    def place(self) -> re.Pattern[str]:
        return re.compile(rf"(?<=<!-- {self.name} -->\n).*?(?=<!-- /{self.name} -->)", re.DOTALL)

    @property
    def text(self) -> str:
        return self.make(self.numbers.read_text(encoding="utf-8"))


TABLES = (
    Table("demo", README, RESULTS / "demo" / "demo.json", demo_table),
    Table("baselines", README, RESULTS / "baselines" / "baselines.json", baselines_table),
    Table("tuned", PROJECT / "docs" / "controllers.md", RESULTS / "robustness" / "robustness.json", tuned_table),
    Table("robustness", PROJECT / "docs" / "controllers.md", RESULTS / "robustness" / "robustness.json", robustness_table),
    Table("hidden-effects", README, HIDDEN / "table.json", hidden_effects_words),
    Table("hidden-effects", PROJECT / "docs" / "hidden-effects.md", HIDDEN / "table.md", hidden_effects_table),
    Table("machines", PROJECT / "docs" / "machines.md", MACHINES / "table.md", hidden_effects_table),
    Table("methods", PROJECT / "docs" / "hidden-effects.md", HIDDEN / "table.json", methods_table),
    Table("rigs", PROJECT / "docs" / "rigs.md", RESULTS / "rigs" / "rigs.json", rigs_tables),
    Table("elastic joint", PROJECT / "docs" / "rigs.md", SERVOS / "table.md", hidden_effects_table),
    Table("probabilities", PROJECT / "docs" / "your-arm.md", SETTINGS_OF_PROBABILITIES, probabilities_words),
    Table("recipes", PROJECT / "docs" / "learning.md", RESULTS / "recipe" / "recipe.md", lines_with("| observation")),
    Table("references", PROJECT / "docs" / "learning.md", RESULTS / "recipe" / "recipe.md", lines_with("| agent")),
    Table("versions", PROJECT / "CONTRIBUTING.md", RESULTS / "versions" / "versions.json", versions_table),
    Table("endurance", PROJECT / "docs" / "reliability.md", RESULTS / "endurance" / "endurance.json", endurance_words),
    Table("lines", PROJECT / "docs" / "reliability.md", RESULTS / "lines" / "lines.json", lines_words),
    Table("scale-out", PROJECT / "docs" / "cluster.md", RESULTS / "speed" / "scale_out.json", scale_out_words),
    Table("times", PROJECT / "docs" / "hidden-effects.md", HIDDEN / "table.json", times_words),
)


@pytest.mark.parametrize("table", TABLES, ids=lambda table: f"{table.name}-{table.document.stem}")
def test_documents_have_the_numbers_of_the_results(table):
    (written,) = table.place.findall(table.document.read_text(encoding="utf-8"))
    assert written == table.text, f"{table.document.name} is not of {table.numbers.name}; write it anew: python {__file__}"


def write(table: Table) -> None:
    """Put the table of the results into its document."""
    made = table.text
    before = table.document.read_text(encoding="utf-8")
    table.document.write_text(table.place.sub(lambda _: made, before), encoding="utf-8")


if __name__ == "__main__":
    sys.path.insert(0, str(PROJECT))
    for each in TABLES:
        write(each)
