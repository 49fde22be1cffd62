"""The page of the reproduction: a table of claims, one of misprints, and every figure."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from flexarm_env.pictures.words import number
from flexarm_env.thesis.claims.claim import FAILS, HOLDS, IN_PART, Claim
from flexarm_env.thesis.errata import Erratum
from flexarm_env.thesis.sheet import Sheet

TITLE = "The thesis, reproduced"
SOURCE = "B. McDonald, Modeling and Control of a Flexible-Link Manipulator, MScEng thesis"
MARKS = {HOLDS: "●", IN_PART: "◐", FAILS: "○"}
_CSS = """
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 1180px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.2rem; margin-top: 2.4rem; }
table { border-collapse: collapse; width: 100%; } th, td { padding: .4rem .8rem .4rem 0; text-align: left; vertical-align: top; }
th { border-bottom: 1px solid #999; } tr + tr td { border-top: 1px solid #e4e4e4; }
td ul { margin: 0; padding: 0; list-style: none; } td li { margin-bottom: .25rem; padding-left: 1.3rem; text-indent: -1.3rem; }
.v { white-space: nowrap; font-weight: 600; } .n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.because { color: #555; } figure { margin: 1.6rem 0; } figcaption { color: #555; max-width: 760px; } img { max-width: 100%; }
.sheets { display: grid; grid-template-columns: repeat(auto-fill, minmax(480px, 1fr)); gap: 0 2rem; }
footer { margin-top: 3rem; color: #666; font-size: .85rem; }
"""


def page(claims: Sequence[Claim], errata: Sequence[Erratum], sheets: Mapping[str, Sequence[Sheet]], made: str) -> str:
    """Build the page's HTML; it refers to the figures' files beside it.

    Args:
        claims: rows, in order.
        errata: misprints, in order.
        sheets: figures by chapter.
        made: version and commit.
    """
    parts = [
        f"<h1>{TITLE}</h1>",
        f"<p>{escape(SOURCE)}. Everything here is computed from its constants with the equations made consistent, on the "
        "product's plant where an arm can have the model. Where the thesis shows its rig, whose recordings are not printed, a "
        "finer model with gears and noise stands in; that is said beside it, and it is no measurement.</p>",
        f"<p>{summary(claims)}</p>",
        "<h2>Claims</h2>",
        _claims(claims),
        "<h2>Misprints, and what they change</h2>",
        _errata(errata),
        *(part for chapter, found in sheets.items() for part in (f"<h2>Figures of {escape(chapter)}</h2>", _sheets(found))),
    ]
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{TITLE}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{_CSS}</style></head>\n<body>\n'
        + "\n".join(parts)
        + f"\n<footer>{escape(made)}. Numbers: <a href='thesis.json'>thesis.json</a>.</footer>\n</body></html>\n"
    )


def summary(claims: Sequence[Claim]) -> str:
    """Count the claims that hold, in a sentence."""
    verdicts = [claim.verdict for claim in claims]
    count = {verdict: verdicts.count(verdict) for verdict in MARKS}
    return f"Of {len(claims)} claims {count[HOLDS]} hold, {count[IN_PART]} hold in part and {count[FAILS]} do not."


def _claims(claims: Sequence[Claim]) -> str:
    rows = []
    for claim in claims:
        parts = "".join(f"<li>{'✓' if part.holds else '✗'} {escape(part.ours)}</li>" for part in claim.parts)
        figures = " ".join(f'<a href="#fig-{n}">{n}</a>' for n in claim.figures)
        rows.append(
            f'<tr id="{claim.key}"><td>{claim.key}</td><td>{escape(claim.words)}<br><small>{escape(claim.where)}</small></td>'
            f"<td><ul>{parts}</ul></td><td><span class=v>{MARKS[claim.verdict]} {claim.verdict}</span><br>"
            f"<span class=because>because {escape(claim.because)}</span></td><td>{figures}</td></tr>"
        )
    head = "<tr><th></th><th>The thesis says</th><th>Here</th><th>Verdict</th><th>Figures</th></tr>"
    return f"<table>{head}{''.join(rows)}</table>"


def _errata(errata: Sequence[Erratum]) -> str:
    rows = [
        f"<tr><td>{e.number}</td><td>{escape(e.where)}</td><td>{escape(e.says)}</td><td>{escape(e.should)}</td>"
        f"<td>{escape(e.effect)}</td><td class=n>{number(e.printed, 4)}</td><td class=n>{number(e.mended, 4)}</td>"
        f"<td>{' '.join(f'<a href=#fig-{n}>{n}</a>' for n in e.figures)}</td></tr>"
        for e in errata
    ]
    head = "".join(f"<th>{h}</th>" for h in ("", "where", "printed", "should be", "changes", "as printed", "mended", "figures"))
    return f"<table><tr>{head}</tr>{''.join(rows)}</table>"


def _sheets(sheets: Sequence[Sheet]) -> str:
    drawn = "".join(
        f'<figure id="fig-{s.number}"><a href="{s.stem}.svg"><img src="{s.stem}.png" loading="lazy" '
        f'alt="Fig. {s.number}: {escape(s.title, quote=True)}"></a><figcaption>{escape(s.note)}</figcaption></figure>'
        for s in sheets
    )
    return f'<div class="sheets">{drawn}</div>'
