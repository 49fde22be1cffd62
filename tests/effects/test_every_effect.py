"""What every effect of the catalogue promises, so that a new one is tested as soon as it is there."""

from __future__ import annotations

import functools
import inspect
import itertools
import math
import re
from collections.abc import Callable
from dataclasses import replace

import numba
import numpy as np
import pytest
from one_joint import servo
from plant_arms import energy_with_gears

from flexarm_env.arm import Arm
from flexarm_env.effects import Effect, catalogue
from flexarm_env.effects.catalogue import LAW_PORTS
from flexarm_env.errors import InputError
from flexarm_env.experiments.simulate import simulate
from flexarm_env.parameters import INPUTS, NEEDS
from flexarm_env.plant.compose import compose
from flexarm_env.plant.ports import PORT_ARGUMENTS
from flexarm_env.sensors import known_sensors
from flexarm_env.units import factor

NAMES = list(catalogue())
LAWS = [(name, port) for name in NAMES for port in LAW_PORTS if catalogue()[name].port(port) is not None]
FRICTION = [name for name, port in LAWS if port == "friction"]
SIZES = (0.3, 1.0, 3.0)
#: Ordinary values of everything that a law may ask for.
GRID = {
    "direction": (-1.0, 1.0),
    "speed": (0.0, 1e-3, 0.1, 2.0, 30.0),
    "angle": (-4.0, -0.3, 0.0, 1.1),
    "time": (0.0, 0.7, 100.0),
    "at_rest": (False, True),
    "velocity": (-20.0, -0.5, 0.0, 0.5, 20.0),
    "command": (-6.0, -0.05, 0.0, 0.05, 6.0),
    "previous": (-6.0, 0.0, 2.0),
    "interval": (0.002, 0.005),
    "start": (0.0, 5e-4),
    "end": (1e-3, 0.002),
    "reading": (-3.0, 0.0, 0.2),
    "motor_angle": (-4.0, 0.0, 1.1),
    "load": (-2.0, 0.0, 0.4),
    "before": (-0.1, 0.0, 0.05),
    "travel": (-0.5, 0.0, 1e-3),
    "level": (0.0, 0.05, 0.2),
    "windup": (-0.05, 0.0, 2e-3),
    "stiffness": (50.0, 4000.0),
}


@pytest.fixture
def arm(request: pytest.FixtureRequest) -> Arm:
    """An arm that has every sensor, so that every effect can be added: a servo where the effect of the test is that of one."""
    name = getattr(request.node, "callspec", None) and request.node.callspec.params.get("name", "")
    thesis = every_sensor()
    return thesis if not name or thesis.can_have(name) else servo().with_effect("viscous", coefficient=0.05)


@functools.cache
def every_sensor() -> Arm:
    """The thesis's arm with every sensor."""
    thesis = Arm.load("thesis-fem")
    others = {name: sensor for name, sensor in known_sensors().items() if name not in thesis.sensors}
    defaults = {name: {key: p.typical for key, p in sensor.settings().items()} for name, sensor in others.items()}
    return replace(thesis, sensors={**thesis.sensors, **{name: values | {"noise": 1e-3} for name, values in defaults.items()}})


def sized(effect: type[Effect], share: float) -> dict[str, float]:
    """Parameters with those that say how strong the effect is at a share of their typical value."""
    values = {}
    for key, p in effect.parameters.items():
        value = p.typical * share if p.null is not None else p.typical
        values[key] = min(max(round(value) if key == "elements" else value, p.low), p.high)
    return values


def absent(effect: type[Effect]) -> dict[str, float]:
    return {key: p.typical if p.null is None else p.null for key, p in effect.parameters.items()}


@pytest.mark.parametrize("name", NAMES)
def test_it_says_what_it_is(name):
    effect = catalogue()[name]
    assert effect.name == name
    assert re.fullmatch(r"[a-z]+(_[a-z]+)*", name)
    assert effect.__module__ == f"flexarm_env.effects.{name}"
    for text in (effect.equation, effect.looks_like, effect.__doc__):
        assert text
        assert text.strip()
    assert set(effect.confused_with) <= set(NAMES) - {name}
    assert set(effect.needs) <= {*NEEDS, "strain", *known_sensors(), *INPUTS}
    assert set(effect.reads) <= {"strain", *known_sensors()}
    assert bool(effect.reads) == (effect.port("sensor") is not None)


@pytest.mark.parametrize("name", NAMES)
def test_its_parameters_are_whole(name):
    effect = catalogue()[name]
    assert effect.parameters
    for key, p in effect.parameters.items():
        assert key.isidentifier()
        assert p.meaning, key
        assert p.unit == "" or factor(p.unit, p.unit) == 1.0
        assert p.low < p.high, key
        assert p.low <= p.typical <= p.high, key
        assert math.isfinite(p.typical), key
        assert p.null is None or p.low <= p.null <= p.high, key
        assert p.spread >= 0.0, key
    assert any(p.null is not None for p in effect.parameters.values()), "no value means absence"
    for start in effect.starts():
        assert set(start) == set(effect.parameters)
        assert all(effect.parameters[key].low <= value <= effect.parameters[key].high for key, value in start.items())
        assert not effect.absent(start)


@pytest.mark.parametrize("name", NAMES)
def test_its_ports_take_its_parameters_and_what_the_port_gives(name):
    effect = catalogue()[name]
    ports = [port for port in ("structure", *LAW_PORTS) if effect.port(port) is not None]
    assert ports
    for port in ports:
        given = ("structure",) if port == "structure" else PORT_ARGUMENTS[port]
        wanted = inspect.signature(effect.port(port)).parameters.values()
        every = {p.name for p in wanted if p.kind is p.VAR_KEYWORD and port == "structure"}
        assert {p.name for p in wanted} - every <= {*given, *effect.parameters}
        assert not set(given) & set(effect.parameters), "a parameter hides what the port gives"


@pytest.mark.parametrize("name", NAMES)
def test_absent_is_bit_equal_to_not_listed(arm, name):
    effect = catalogue()[name]
    without = arm.without_effect(name)
    null = without.with_effect(name, **absent(effect))
    runs = [simulate(a, "square", duration=1.0) for a in (without, null)]
    assert runs[0].command.tobytes() == runs[1].command.tobytes()
    for signal in arm.signals:
        assert runs[0].signals[signal].tobytes() == runs[1].signals[signal].tobytes()


@pytest.mark.parametrize("name", NAMES)
def test_next_to_absence_it_moves_next_to_nothing(arm, name):
    effect = catalogue()[name]
    small = {
        key: value
        if (p := effect.parameters[key]).null is None or p.is_count or p.null == math.inf
        else p.null + 1e-9 * p.typical
        for key, value in absent(effect).items()
    }
    without = arm.without_effect(name)
    runs = [simulate(a, "square", duration=0.5) for a in (without, without.with_effect(name, **small))]
    for signal in arm.signals:
        was, now = (run.signals[signal] for run in runs)
        assert np.abs(now - was).max() <= 0.05 * np.ptp(was) + 1e-9, signal


@pytest.mark.parametrize("name", NAMES)
def test_it_changes_what_is_measured(arm, name):
    base = arm.with_values({"beam.elements": 1.0}) if arm.has("beam") else arm
    with_it = base.without_effect(name).with_effect(name, **sized(catalogue()[name], 1.0))
    runs = [simulate(a, "square", duration=4.5, noise=False) for a in (base.without_effect(name), with_it)]
    assert any((runs[0].signals[s] != runs[1].signals[s]).any() for s in arm.signals)


@functools.cache
def jitted_law(port: str) -> Callable[..., float]:
    """The kernel's switch over the laws of a port. Only compiled code can call it, so it gets a caller."""
    scope = {"law": getattr(compose(catalogue().laws), f"{port}_law")}
    arguments = ", ".join(("kind", *PORT_ARGUMENTS[port], "d", "k"))
    exec(f"def call({arguments}): return law({arguments})", scope)
    return numba.njit(scope["call"])


@pytest.mark.parametrize(("name", "port"), LAWS)
def test_jitted_equals_python(name, port):
    effect, kind = catalogue()[name], catalogue().kinds[name, port]
    jitted, python = jitted_law(port), effect.port(port)
    for share in SIZES:
        values = sized(effect, share)
        data = np.array(list(values.values()))
        for point in itertools.product(*(GRID[quantity] for quantity in PORT_ARGUMENTS[port])):
            given = dict(zip(PORT_ARGUMENTS[port], point, strict=True))
            expected = python(**{a: (given | values)[a] for a in inspect.signature(python).parameters})
            assert jitted(kind, *point, data, 0) == pytest.approx(expected, rel=1e-14, abs=1e-300)


@pytest.mark.parametrize("share", SIZES)
@pytest.mark.parametrize("name", NAMES)
def test_it_stays_finite(arm, name, share):
    run = simulate(arm.with_effect(name, **sized(catalogue()[name], share)), "square", noise=False)
    for signal, values in run.signals.items():
        assert np.isfinite(values).all(), signal
    assert np.abs(run.signals["arm_angle"]).max() < 20.0


@pytest.mark.parametrize("name", FRICTION)
def test_friction_dissipates(arm, name):
    alone = replace(arm, effects={}).with_effect(name, **sized(catalogue()[name], 3.0))
    structure, plant = alone.structure(), alone.plant(0.005)
    plant.place()
    plant.replay(np.full(60, 3.0))
    levels = [energy_with_gears(plant, structure)]
    for _ in range(600):
        plant.replay(np.zeros(2))
        levels.append(energy_with_gears(plant, structure))
    assert levels[0] > 0.01
    assert np.diff(levels).max() <= 1e-9 * levels[0]


@pytest.mark.parametrize("name", FRICTION)
def test_it_says_whether_its_friction_changes_while_the_hub_turns_one_way(name):
    effect = catalogue()[name]
    law = effect.port("friction")
    values = sized(effect, 1.0) | {"direction": 1.0, "at_rest": False}
    others = [key for key in inspect.signature(law).parameters if key not in values]
    points = itertools.product(*(GRID[quantity] for quantity in others))
    frictions = {
        law(**{k: (values | dict(zip(others, p, strict=True)))[k] for k in inspect.signature(law).parameters}) for p in points
    }
    assert effect.varies == (len(frictions) > 1)


@pytest.mark.parametrize("name", NAMES)
def test_a_misspelt_name_gets_a_hint(arm, name):
    wrong = name[:-2] + name[-1]
    with pytest.raises(InputError, match="did you mean"):
        arm.with_effect(wrong)


@pytest.mark.parametrize("name", NAMES)
def test_a_misspelt_parameter_or_a_value_out_of_bounds_is_refused(arm, name):
    key, p = next(iter(catalogue()[name].parameters.items()))
    with pytest.raises(InputError, match=f"no parameter '{key}x'"):
        arm.with_effect(name, **{f"{key}x": 1.0})
    if math.isfinite(p.high):
        with pytest.raises(InputError, match="out of bounds"):
            arm.with_effect(name, **{key: p.high * 2.0 + 1.0})
