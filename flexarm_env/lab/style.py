"""Colours and style sheet of the lab."""

from __future__ import annotations

from flexarm_env.pictures.style import DARK

PRIMARY = "#005a8c"  # white text on it has a contrast of 7

CSS = (
    """
body { font: 16px/1.45 system-ui, sans-serif; color: #222; background: #f6f7f8; }
.nicegui-content { padding: 0; }
.lab { max-width: 1420px; width: 100%; margin: 0 auto; padding: .8rem 1.2rem 3rem; box-sizing: border-box; }
h1 { font-size: 1.15rem; font-weight: 600; line-height: 1.4; margin: 0; letter-spacing: 0; }
h2 { font-size: 1rem; font-weight: 600; line-height: 1.4; margin: 0 0 .5rem; letter-spacing: 0; }
.top { display: flex; flex-wrap: wrap; gap: .3rem 1rem; align-items: baseline; margin-bottom: .6rem; }
.top .hint { color: #555; }
.board {
  display: grid; gap: 1rem; grid-template-columns: 340px minmax(0, 1fr);
  grid-template-areas: "data view" "effects view"; grid-template-rows: auto 1fr;
}
.data { grid-area: data; } .view { grid-area: view; } .choose { grid-area: effects; }
.card { background: #fff; border: 1px solid #d5d8db; border-radius: 8px; padding: .9rem 1rem; margin-bottom: 1rem; }
.verdict { font-size: 1.2rem; line-height: 1.35; border-left: 6px solid #0072b2; padding: .2rem 0 .2rem .8rem; }
.complaint {
  background: #fff3ec; border: 2px solid #b34700; border-radius: 8px;
  padding: .6rem .9rem; margin-bottom: 1rem; overflow-wrap: anywhere; }
.complaint::before { content: "⚠ "; }
.tiles { display: flex; flex-wrap: wrap; gap: .3rem 2rem; align-items: end; margin-bottom: .5rem; }
.tile .number { font-size: 1.7rem; font-weight: 600; line-height: 1.2; font-variant-numeric: tabular-nums; }
.tile .what { font-size: .85rem; color: #555; }
.results { display: grid; gap: 1rem; grid-template-columns: repeat(auto-fit, minmax(min(380px, 100%), 1fr)); }
.results .card { margin-bottom: 0; }
.files { list-style: none; padding: 0; margin: .5rem 0; }
.files li { display: flex; justify-content: space-between; align-items: center; overflow-wrap: anywhere; }
.row { display: flex; flex-wrap: wrap; gap: .5rem; align-items: center; }
.effects { max-height: 46rem; overflow-y: auto; }
.effect { border-top: 1px solid #eceeef; padding: .25rem 0; }
.sliders { padding: 0 .6rem 0 2rem; } .sliders .muted { font-size: .8rem; line-height: 1.3; }
.setting { display: flex; justify-content: space-between; font-size: .85rem; margin-top: .2rem; }
.setting .value { font-variant-numeric: tabular-nums; font-weight: 600; }
.ranked {
  display: grid; grid-template-columns: minmax(0, 1fr) 4.2rem auto; gap: .1rem .7rem; align-items: center;
  border-top: 1px solid #eceeef; padding: .35rem 0;
}
.ranked .gain { text-align: right; font-variant-numeric: tabular-nums; }
.ranked .parameters { grid-column: 1 / -1; font-size: .85rem; color: #555; overflow-wrap: anywhere; }
.ranked .bar { grid-column: 1 / -1; height: .45rem; background: #e4e6e8; } .ranked .bar div { height: 100%; background: #7d8388; }
.ranked.accepted .bar div { background: #0072b2; } .ranked.accepted .effect-name { font-weight: 700; }
.faults { list-style: disc; margin: .4rem 0; padding-left: 1.2rem; } .faults:empty { display: none; }
.faults li { overflow-wrap: anywhere; } .faults code { font-size: .85rem; background: #f2f4f5; padding: .1rem .3rem; }
.scroll { overflow-x: auto; } .scroll table { border-collapse: collapse; font-size: .85rem; margin-bottom: .8rem; }
.scroll th, .scroll td {
  text-align: left; padding: .15rem .9rem .15rem 0; white-space: nowrap; font-variant-numeric: tabular-nums;
}
.scroll th { border-bottom: 1px solid #888; } .scroll tr + tr td { border-top: 1px solid #eceeef; }
.signals .nicegui-expansion-content { padding: .4rem 0 0; } .signals .nicegui-expansion-content > * { width: 100%; min-width: 0; }
.signals .q-item { padding-left: 0; } .signals .nicegui-expansion-content > button { width: auto; }
.muted { color: #555; font-size: .9rem; }
.q-uploader { display: none; }
.drop { display: block; border: 2px dashed #6b7379; border-radius: 8px; padding: 1rem; text-align: center; cursor: pointer; }
.drop.over { background: #e3f0f8; border-color: #005a8c; } .drop:focus-within { outline: 3px solid #0072b2; }
.drop input { position: absolute; opacity: 0; width: 1px; height: 1px; }
.q-btn { text-transform: none; }
.empty { font-size: 1.1rem; line-height: 1.9; margin: .5rem 0; padding-left: 1.4rem; }
.plot { width: 100%; }
@media (max-width: 900px) {
  .lab { padding: .6rem .7rem 2rem; }
  .board { grid-template-columns: minmax(0, 1fr); grid-template-areas: "data" "view" "effects"; grid-template-rows: none; }
  .verdict { font-size: 1.05rem; } .effects { max-height: none; }
}
"""
    + DARK
)
