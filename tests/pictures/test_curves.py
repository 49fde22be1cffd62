"""Pictures for print: what is written in them can be read."""

from __future__ import annotations

import itertools

import pytest

pytest.importorskip("matplotlib")

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

from flexarm_env.pictures import curves, words

ONE = ["backlash"]
THREE = ["asymmetric_coulomb", "position_friction", "root_compliance"]


@pytest.mark.parametrize("effects", [ONE, THREE])
def test_no_text_of_the_falling_error_lies_on_another(effects):
    error = {"nominal": 24.1, "refitted": 23.6, "final": 1.15} | dict.fromkeys(effects, 1.2)
    free = {key: 3.0 * error[key] for key in ("nominal", "refitted", "final")}
    figure = curves.waterfall(words.steps_of(error, effects), words.steps_of(free, effects))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    shown = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text()]
    for axes in figure.axes:  # a tick beyond the axes is not drawn, though its text is there
        hidden = [t.label1 for t in axes.xaxis.get_major_ticks() if t.get_loc() > axes.get_xlim()[1]]
        shown = [t for t in shown if not any(t is h for h in hidden)]
    for name in effects:
        assert sum(name.replace("_", " ") in t.get_text() for t in shown) == 2
    boxes = {t: t.get_window_extent(canvas.get_renderer()) for t in shown}
    for one, other in itertools.combinations(shown, 2):
        assert not boxes[one].overlaps(boxes[other]), (one.get_text(), other.get_text())
    for text, box in boxes.items():
        assert 0.0 <= box.x0 <= box.x1 <= figure.bbox.x1, text.get_text()


def test_each_model_has_one_bar():
    steps = words.steps_of({"nominal": 24.1, "refitted": 23.6, "backlash": 1.12, "final": 1.15}, ONE)
    figure = curves.waterfall(steps, steps)
    for axes in figure.axes:
        assert [bar.get_width() for bar in axes.patches] == [24.1, 23.6, 1.15]
