"""The shipped tuned controllers: one budget for all, and each better than where it started."""

from __future__ import annotations

from flexarm_env.controllers import CONTROLLERS, tuned_recipe
from flexarm_env.controllers.tuned import shipped_controllers


def test_the_shipped_controllers_were_tuned_with_one_budget() -> None:
    shipped = shipped_controllers()
    assert {"lqg_tuned", "mpc_tuned", "pid_compensated_tuned", "pd_tuned"} <= set(shipped)
    assert len({(each.search["trials"], each.search["arms"], tuple(each.search["cells"])) for each in shipped.values()}) == 1
    for name, each in shipped.items():
        assert name == f"{each.controller}_tuned"
        assert each.search["score"] < each.search["score_before"]
        assert CONTROLLERS[name] == tuned_recipe(each)
