"""The search for what is missing: effects change places, and what begins too large begins again."""

from __future__ import annotations

import pytest

from flexarm_env import Arm
from flexarm_env.identify import fits
from flexarm_env.identify.acceptance import Acceptance
from flexarm_env.identify.data import Data, prepare
from flexarm_env.identify.problem import score
from flexarm_env.identify.refit import best_refit, refit
from flexarm_env.identify.search import Search
from flexarm_env.identify.simulate import simulate

TRUE = {
    "asymmetric_coulomb": {"torque": 0.05},
    "constant_torque": {"torque": 0.05},
}


def searched(taken: str, data: Data, nominal: Arm) -> Search:
    """A search that has taken an effect already."""
    search = Search(nominal, data, 1, lambda done, text: None)
    search.first = score(best_refit(nominal, data).arm, data)
    search.rules = Acceptance(search.first, search.noisy)
    search.found = refit(nominal.with_effect(taken, torque=0.04), nominal, data)
    search.best = score(search.found.arm, data)
    search.accepted, search.equivalent, search.steps = [taken], [[taken]], {taken: search.best}
    return search


@pytest.mark.parametrize("taken", sorted(TRUE))
@pytest.mark.parametrize("hidden", sorted(TRUE))
def test_what_was_taken_gives_way_to_what_fits_better(hidden, taken):
    nominal = Arm.load("thesis")
    made = nominal.with_effect(hidden, **TRUE[hidden])
    arm, data = prepare(nominal, [simulate(made, experiment, seed=3, duration=8.0) for experiment in ("square", "sweep")])
    search = searched(taken, data, arm)
    search._swap(0.5)
    assert search.accepted == [hidden]
    assert search.equivalent[0][0] == hidden
    assert list(search.steps) == [hidden]
    assert search.best.windows < 1.05


def test_an_effect_that_began_too_large_begins_again(monkeypatch):
    nominal = Arm.load("thesis-fem")
    made = nominal.with_effect("backlash", gap=0.0007).with_values({"hub.inertia": 1.2 * nominal.value("hub.inertia")})
    arm, data = prepare(nominal, [simulate(made, "pulse", seed=1, duration=5.0)])
    monkeypatch.setattr(fits, "candidates", lambda arm: ["backlash", "current_lag"])
    base = best_refit(arm, data)
    untried = fits.Trial("", base.arm, 0.0, 0.0)
    found = fits.Fits(arm, data, 1, lambda done, text: None).with_all_constants(base, [untried], [], 0.0, 1.0)
    assert found[0].effects == ("backlash",)
    assert found[0].refit.arm.effects["backlash"]["gap"] == pytest.approx(0.0007, rel=0.1)
    assert found[0].score.windows < 0.5 * score(base.arm, data).windows
