"""One self-contained HTML document with Plotly figures; it needs no network.

Plotly's library alone has 4.8 MB as text, so the page holds it and the figures compressed, and the browser unpacks them.
"""

from __future__ import annotations

import base64
import functools
import gzip
from collections.abc import Sequence
from html import escape

import plotly.graph_objects as go
import plotly.offline

from flexarm_env import __version__
from flexarm_env.pictures.style import AFTER, DARK, GRID, INK

CSS = f"""
:root {{ color-scheme: light; }}
body {{ font: 16px/1.5 system-ui, sans-serif; color: {INK}; background: #fff; max-width: 1120px; margin: 0 auto; padding: 1rem; }}
h1 {{ font-size: 1.1rem; font-weight: 600; color: #555; margin: .4rem 0; }}
h2 {{ font-size: 1.2rem; margin: 2.4rem 0 .4rem; border-top: 1px solid #ccc; padding-top: 1rem; }}
h3 {{ font-size: 1rem; margin: 1rem 0 .2rem; }}
.verdict {{
  font-size: 1.3rem; line-height: 1.35; border-left: 6px solid {AFTER}; padding: .3rem 0 .3rem .9rem; margin: .6rem 0 1rem;
}}
.panels {{ display: grid; grid-template-columns: repeat(auto-fit, minmax(min(320px, 100%), 1fr)); gap: 0 1.2rem; }}
.panels.wide {{ grid-template-columns: repeat(auto-fit, minmax(min(440px, 100%), 1fr)); }}
figure {{ margin: .4rem 0; min-width: 0; break-inside: avoid; }}
figcaption {{ font-size: .88rem; color: #444; }}
figcaption b {{ color: {INK}; font-size: .98rem; }}
.scroll {{ overflow-x: auto; }}
table {{ border-collapse: collapse; font-size: .93rem; }}
th, td {{ padding: .22rem 1rem .22rem 0; text-align: left; vertical-align: top; }}
th {{ font-weight: 600; border-bottom: 1px solid #888; }}
tr + tr td {{ border-top: 1px solid {GRID}; }}
.n {{ text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }}
p, li, h3, h1 {{ overflow-wrap: anywhere; }}
pre {{ background: #f4f4f4; padding: .7rem; overflow-x: auto; font-size: .88rem; }}
td.text {{ min-width: 15rem; }} td.code {{ font-family: ui-monospace, monospace; font-size: .82rem; overflow-wrap: anywhere; }}
details {{ margin: .6rem 0; }} summary {{ cursor: pointer; padding: .3rem 0; font-weight: 600; }}
footer {{ margin-top: 2.5rem; color: #555; font-size: .85rem; }}
@media (max-width: 600px) {{ body {{ padding: .7rem; }} .verdict {{ font-size: 1.12rem; }} th, td {{ padding-right: .6rem; }} }}
{DARK}
@media print {{ body {{ max-width: none; font-size: 11pt; }} h2, h3, summary {{ break-after: avoid; }}
  .modebar, .updatemenu-container {{ display: none; }}
  .panels.wide {{ grid-template-columns: 1fr 1fr; }} .panels {{ grid-template-columns: 1fr 1fr; }} }}
"""
_CONFIG = '{"displaylogo":false,"responsive":true}'
#: Width and largest height [px] of a figure on paper: of A4 between usual margins.
_PAPER, _PAPER_HEIGHT = 690, 940
_UNPACK = f"""
async function unpack(place) {{
  const bytes = Uint8Array.from(atob(place.textContent), c => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}}
const places = [...document.querySelectorAll("div.plot")];
function draw(place) {{
  if (place.drawn || !place.figure) return;
  place.drawn = true;
  place.replaceChildren();
  return Plotly.newPlot(place, place.figure.data, place.figure.layout, {_CONFIG});
}}
function onPaper() {{
  for (const one of document.querySelectorAll("details")) one.open = true;
  for (const place of places) {{
    draw(place);
    const width = place.closest(".panels") ? {_PAPER // 2 - 12} : {_PAPER};
    Plotly.relayout(place, {{width, height: Math.min(place.figure.layout.height, {_PAPER_HEIGHT}), autosize: false}});
    place.style.height = "auto";
  }}
}}
function onScreen() {{
  for (const place of places) {{
    place.style.height = `${{place.figure.layout.height}}px`;
    Plotly.relayout(place, {{width: null, height: place.figure.layout.height, autosize: true}});
  }}
}}
(async () => {{
  const library = document.createElement("script");
  library.textContent = await unpack(document.getElementById("plotly"));
  document.head.append(library);
  for (const place of places) place.figure = JSON.parse(await unpack(place.firstElementChild));
  for (const place of places) if (!place.closest("details:not([open])")) await draw(place);
  for (const one of document.querySelectorAll("details"))
    one.addEventListener("toggle", () => one.querySelectorAll("div.plot").forEach(draw));
  addEventListener("beforeprint", onPaper);
  addEventListener("afterprint", onScreen);
  document.documentElement.dataset.drawn = "yes";
}})().catch(error => {{
  for (const place of places)
    place.textContent = `This browser cannot draw the figure (${{error}}); any of 2023 or later can.`;
}});
"""


def document(title: str, parts: Sequence[str]) -> str:
    """Assemble the page from a heading and its parts."""
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        f'<meta name="viewport" content="width=device-width, initial-scale=1"><style>{CSS}</style>'
        f"</head>\n<body><main><h1>{escape(title)}</h1>\n"
        + "\n".join(parts)
        + f"\n</main><footer>FlexArm {__version__}</footer>\n"
        + _library()
        + f"\n<script>{_UNPACK}</script></body></html>\n"
    )


@functools.cache
def _library() -> str:
    return _packed(plotly.offline.get_plotlyjs(), ' id="plotly"')


def figure(drawn: go.Figure, name: str, heading: str = "", caption: str = "") -> str:
    """Embed a figure with its caption.

    Args:
        drawn: the figure, with its height set.
        name: unique in the page.
        heading: names the quantity shown.
        caption: explains how to read it.
    """
    place = "figure-" + "".join(c if c.isalnum() else "-" for c in name)
    plot = f'<div class="plot" id="{place}" style="height:{drawn.layout.height}px">{_packed(drawn.to_json())}</div>'
    bold = f"<b>{escape(heading)}</b> " if heading else ""
    words = f"<figcaption>{bold}{escape(caption)}</figcaption>" if heading or caption else ""
    return f"<figure>{words}{plot}</figure>"


def _packed(text: str, attributes: str = "") -> str:
    """Compress text into an element that a browser neither shows nor runs."""
    packed = base64.b64encode(gzip.compress(text.encode(), compresslevel=9, mtime=0)).decode()
    return f'<script type="text/plain"{attributes}>{packed}</script>'


def panels(figures: Sequence[str], wide: bool = False) -> str:
    """Place figures side by side where there is room."""
    return f'<div class="panels{" wide" if wide else ""}">' + "".join(figures) + "</div>"


def section(heading: str, *parts: str) -> str:
    """Place parts under a heading; an empty text where there are none."""
    inner = "\n".join(part for part in parts if part)
    return f"<h2>{escape(heading)}</h2>\n{inner}" if inner else ""


def folded(summary: str, *parts: str) -> str:
    """Fold parts under a summary that opens at a click."""
    return f"<details><summary>{escape(summary)}</summary>" + "\n".join(parts) + "</details>"


def paragraph(text: str, kind: str = "") -> str:
    """Format a paragraph, with a CSS class if one is given."""
    return f"<p{f' class={kind}' if kind else ''}>{escape(text)}</p>"


def bullets(lines: Sequence[str]) -> str:
    """Format lines as a bulleted list."""
    return "<ul>" + "".join(f"<li>{escape(line)}</li>" for line in lines) + "</ul>" if lines else ""


def table(columns: Sequence[str], rows: Sequence[Sequence[str]], words: int = 1, code: Sequence[int] = ()) -> str:
    """Format a table.

    Args:
        columns: headings.
        rows: cells.
        words: number of leading columns that hold text; the others hold numbers and are aligned right.
        code: indices of columns set in a monospaced font.
    """

    def kind(i: int) -> str:
        return " class=code" if i in code else " class=text" if 1 < i < words else "" if i < words else " class=n"

    head = "".join(f'<th scope="col"{kind(i)}>{escape(column)}</th>' for i, column in enumerate(columns))
    body = "".join("<tr>" + "".join(f"<td{kind(i)}>{escape(c)}</td>" for i, c in enumerate(row)) + "</tr>" for row in rows)
    return f'<div class="scroll" tabindex="0"><table><tr>{head}</tr>{body}</table></div>'
