"""The pictures of an arm: that they show what the numbers say, everywhere the same, with no display."""

from __future__ import annotations

import math
import os
import sys
from dataclasses import replace

import numpy as np
import pytest
from gymnasium.error import ClosedEnvironmentError, DependencyNotInstalled

from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.plant.assembly import assemble
from flexarm_env.plant.structure import Structure
from flexarm_env.render import Renderer, Scene, beam_shape
from flexarm_env.render.canvas import number
from flexarm_env.render.style import BEAM, GAGE, HUB_AT, INK, PANEL, REACH, SIZE, STUCK, TABLE, TARGET
from flexarm_env.sensors.arm_angle import ArmAngle

# PYGAME_HIDE_SUPPORT_PROMPT is what the renderer sets itself before its own import.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")

LENGTH = 0.8
STATIONS = np.linspace(0.0, LENGTH, 33)
TIMES = np.arange(0.0, 3.0, 0.01)
STRAIN = (TIMES, 0.8 * np.sin(12 * TIMES))


def cantilever(x, tip):
    """Deflection [m] at x of a beam of LENGTH that a force at its end bends by `tip` there."""
    u = x / LENGTH
    return tip * u**2 * (3 - u) / 2


SCENE = Scene(3.0, 0.4, False, STATIONS, cantilever(STATIONS, 0.1), math.radians(100), 0.5, STRAIN, "test")


@pytest.fixture
def pygame():
    return pytest.importorskip("pygame")


@pytest.fixture
def renderer(pygame):
    renderer = Renderer("rgb_array", LENGTH, 50, gages=(0.02, 0.44))
    yield renderer
    renderer.close()


def places_of(picture, colour, box=TABLE):
    """Pixels (k, 2) x and y of exactly that colour inside a box (left, top, width, height)."""
    left, top, width, height = (int(edge) for edge in box)
    found = np.argwhere((picture[top : top + height, left : left + width] == colour).all(axis=2))
    return found[:, ::-1] + (left, top)


def test_a_picture_is_pixels(renderer):
    picture = renderer.draw(SCENE)
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    assert picture.dtype == np.uint8
    assert picture.flags.writeable
    assert picture.flags.c_contiguous


def test_the_same_scene_gives_the_same_picture(renderer):
    first = renderer.draw(SCENE)
    renderer.draw(replace(SCENE, stuck=True, title="another", hub_angle=-2.0))
    other = Renderer("rgb_array", LENGTH, 50, gages=(0.02, 0.44))
    np.testing.assert_array_equal(renderer.draw(SCENE), first)
    np.testing.assert_array_equal(other.draw(SCENE), first)


@pytest.mark.parametrize(
    "change",
    [
        {"time": 3.5},
        {"hub_angle": 0.5},
        {"deflection": np.zeros_like(STATIONS)},
        {"target": None},
        {"command": -0.5},
        {"trace": (TIMES, np.cos(TIMES))},
        {"title": "other"},
    ],
    ids=lambda change: next(iter(change)),
)
def test_every_quantity_shows(renderer, change):
    assert (renderer.draw(replace(SCENE, **change)) != renderer.draw(SCENE)).any()


def test_sticking_shows_in_colour_and_in_shape(renderer):
    moving, stuck = renderer.draw(SCENE), renderer.draw(replace(SCENE, stuck=True))
    assert len(places_of(moving, STUCK)) == 0
    assert len(places_of(stuck, STUCK)) > 200
    grey = np.abs(moving.mean(axis=2) - stuck.mean(axis=2))
    assert np.count_nonzero(grey > 40) > 200


@pytest.mark.parametrize("angle", [0.0, 0.4, math.pi / 2, -2.5, 9.0])
@pytest.mark.parametrize(("tip", "exaggeration"), [(0.0, 1.0), (0.16, 1.0), (-0.16, 1.0), (0.01, 12.0)])
def test_the_tip_is_drawn_where_the_closed_form_says(pygame, angle, tip, exaggeration):
    scene = replace(SCENE, hub_angle=angle, deflection=cantilever(STATIONS, tip), target=None)
    picture = Renderer("rgb_array", LENGTH, 50, exaggeration=exaggeration).draw(scene)
    share = exaggeration * tip / LENGTH
    where = angle + math.atan(share)
    expected = np.array(HUB_AT) + REACH * math.hypot(1.0, share) * np.array([math.cos(where), -math.sin(where)])
    direction = angle + math.atan(1.5 * share)  # of the beam at its tip
    beam = places_of(picture, BEAM) + 0.5
    along = beam @ [math.cos(direction), -math.sin(direction)]
    drawn = beam[along > along.max() - 1.5].mean(axis=0)
    assert np.hypot(*(drawn - expected)) < 2.0
    assert abs((drawn - expected) @ [math.sin(direction), math.cos(direction)]) < 0.7


def test_the_target_points_to_its_angle(renderer):
    picture = renderer.draw(replace(SCENE, hub_angle=2.0, target=-0.7))
    ray = places_of(picture, TARGET) + 0.5 - HUB_AT
    ray = ray[np.hypot(*ray.T) < REACH]
    assert len(ray) > 20
    np.testing.assert_allclose(np.arctan2(-ray[:, 1], ray[:, 0])[np.hypot(*ray.T) > 60], -0.7, atol=0.03)


def test_gages_lie_on_the_beam(renderer):
    straight = replace(SCENE, hub_angle=0.0, deflection=np.zeros_like(STATIONS), target=None)
    marks = places_of(renderer.draw(straight), GAGE) + 0.5 - HUB_AT
    for gage in (0.02, 0.44):
        near = marks[np.abs(marks[:, 0] - REACH * gage / LENGTH) < 5]
        np.testing.assert_allclose(near.mean(axis=0), [REACH * gage / LENGTH, 0.0], atol=1.0)


def test_exaggeration_is_told(pygame):
    corner = (TABLE[0], TABLE[1], 110, 28)
    honest, bent = (Renderer("rgb_array", LENGTH, 50, exaggeration=factor).draw(SCENE) for factor in (1.0, 2.0))
    assert len(places_of(honest, INK, corner)) == 0
    assert len(places_of(bent, INK, corner)) > 20


@pytest.mark.parametrize("kept", [0, 1])
def test_a_trace_may_be_empty_or_one_reading(renderer, kept):
    picture = renderer.draw(replace(SCENE, trace=(TIMES[:kept], STRAIN[1][:kept])))
    assert len(places_of(picture, BEAM, PANEL)) == 0


def test_the_trace_stays_in_its_panel(renderer):
    times = np.arange(0.0, 40.0, 0.005)
    picture = renderer.draw(replace(SCENE, time=40.0, trace=(times, 730.0 * np.sign(np.sin(3 * times)))))
    left, top, width, height = PANEL
    below = places_of(picture, BEAM, (0, TABLE[1] + TABLE[3], SIZE[0], SIZE[1] - TABLE[1] - TABLE[3]))
    assert len(below) > 500
    assert (below >= (left - 1, top)).all()
    assert (below <= (left + width + 1, top + height)).all()


def test_pixels_need_no_display(pygame, monkeypatch):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("SDL_VIDEODRIVER", "none-of-these")
    assert Renderer("rgb_array", LENGTH, 50).draw(SCENE) is not None
    assert not pygame.display.get_init()


def test_a_window_shows_the_same(pygame, monkeypatch, renderer):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    window = Renderer("human", LENGTH, 1000, gages=renderer.gages)
    try:
        assert window.draw(SCENE) is None
        shown = pygame.surfarray.array3d(pygame.display.get_surface()).transpose(1, 0, 2)
        np.testing.assert_array_equal(shown, renderer.draw(SCENE))
    finally:
        window.close()
    assert not pygame.display.get_init()


def test_another_user_of_pygame_may_quit_it(pygame, renderer):
    first = renderer.draw(SCENE)
    pygame.quit()
    np.testing.assert_array_equal(renderer.draw(SCENE), first)
    renderer.draw(replace(SCENE, title="letters that were not drawn before"))


@pytest.mark.parametrize("mode", ["human", "rgb_array"])
def test_a_closed_renderer_says_so(pygame, mode):
    renderer = Renderer(mode, LENGTH, 50)
    renderer.close()
    renderer.close()
    with pytest.raises(ClosedEnvironmentError, match="closed"):
        renderer.draw(SCENE)


def test_without_pygame_it_says_how_to_install_it(monkeypatch):
    monkeypatch.setitem(sys.modules, "pygame", None)
    with pytest.raises(DependencyNotInstalled, match=r'pip install "flexarm-env\[render\]"'):
        Renderer("rgb_array", LENGTH, 50)


@pytest.mark.parametrize("wrong", [{"mode": "ansi"}, {"length": 0.0}, {"length": math.nan}, {"fps": 0.0}, {"exaggeration": -1.0}])
def test_wrong_settings_are_refused(wrong):
    with pytest.raises(InputError, match=next(iter(wrong))):
        Renderer(**{"mode": "rgb_array", "length": LENGTH, "fps": 50.0} | wrong)


@pytest.mark.parametrize(("value", "form", "text"), [(-0.04, "+.1f", "0.0"), (-1.25, ".2f", "−1.25"), (3.0, "+g", "+3")])
def test_numbers_have_a_true_minus_and_no_signed_zero(value, form, text):
    assert number(value, form) == text


def structure(elements, **more):
    beam = {"length": LENGTH, "mass_per_length": 0.4, "bending_stiffness": 8.0, "elements": elements} if elements else {}
    return Structure(gear_ratio=1.5, torque_constant=0.33, motor_inertia=0.002, hub_inertia=0.001, **beam, **more)


@pytest.mark.parametrize("more", [{}, {"root_compliance": 0.01}, {"gear_gap": 0.01, "current_lag": 0.01}])
@pytest.mark.parametrize("elements", [1, 6])
def test_the_shape_is_that_of_the_closed_form(elements, more):
    arm = structure(elements, **more)
    names = assemble(arm).names
    shape = beam_shape(arm, STATIONS)
    tip, root = 0.05, 0.02 if "root" in names else 0.0
    state = np.zeros(shape.shape[1])
    state[0] = 1.3  # the hub's angle bends nothing
    if "root" in names:
        state[names.index("root")] = root
    for node in range(1, elements + 1):
        x = node * LENGTH / elements
        state[names.index(f"deflection_{node}")] = cantilever(x, tip) + root * x
        state[names.index(f"slope_{node}")] = tip * x * (6 * LENGTH - 3 * x) / (2 * LENGTH**3) + root
    np.testing.assert_allclose(shape @ state, cantilever(STATIONS, tip) + root * STATIONS, atol=1e-14)


def test_a_rigid_arm_stays_straight():
    shape = beam_shape(structure(0, sensors={"arm_angle": ArmAngle.channel(filter=0.01)}), STATIONS)
    np.testing.assert_array_equal(shape, np.zeros((len(STATIONS), 3)))


@pytest.mark.parametrize("name", ["thesis", "thesis-fem"])
def test_the_shape_fits_the_plant(name):
    arm = Arm.load(name)
    tip_sensor = {**arm.sensors["strain_base"], "gain": 1.0, "position": 0.0}
    arm = replace(arm, sensors={**arm.sensors, "tip_deflection": tip_sensor})
    plant, linear = arm.plant(0.005), arm.structure()
    plant.place()
    tip = plant.replay(np.r_[np.full(40, 4.0), np.zeros(20)])[-1, plant.signals.index("tip_deflection")]
    shape = beam_shape(linear, np.linspace(0.0, linear.length, 5))
    assert shape.shape == (5, plant.states)
    assert abs(tip) > 1e-3
    assert (shape @ plant.physical())[-1] == pytest.approx(tip)
