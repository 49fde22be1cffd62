"""Margins of a control loop, measured as on a machine: by an impulse that is added to the command."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from flexarm_env.arm import Arm
from flexarm_env.controllers import Controller
from flexarm_env.errors import InputError
from flexarm_env.linear import linearise

Floats = NDArray[np.float64]

#: Size of the impulse over the drive's limit, or in A or V where there is none: too small to meet a limit.
IMPULSE = 1e-3
#: The response has ended where its largest value in a stretch of samples is below this share of its largest ever.
ENDED, STRETCH = 1e-5, 400
#: The loop is not stable where it has not ended after this number of samples.
LONGEST = 40_000
#: Effects without which an arm's friction is linear.
DRY_FRICTION = ("coulomb", "asymmetric_coulomb", "stiction", "stribeck", "presliding", "load_friction", "position_friction")
#: Share of a sample below which two instants are one.
SAME_INSTANT = 1e-9
#: Least number of points of the Fourier transform.
POINTS = 2**16


@dataclass(frozen=True)
class Margins:
    """Distance of a loop from instability, with the loop opened at the command.

    Attributes:
        gain: factor by which the loop's gain may rise; infinity where none makes it unstable.
        less_gain: factor to which the gain may fall; 0 where none makes it unstable.
        phase: [deg].
        delay: dead time that the loop stands [s]; infinity where the loop's gain is below 1 everywhere.
        modulus: least distance of the loop's frequency response from −1.
    """

    gain: float
    less_gain: float
    phase: float
    delay: float
    modulus: float

    def table(self) -> dict[str, float]:
        """Round to four digits, by name."""
        return {name: float(f"{value:.4g}") for name, value in asdict(self).items()}


def margins_of(make: Callable[[Arm], Controller], arm: Arm) -> Margins:
    """Compute the least margins over the regions of a controller on a moving arm.

    While the arm moves, dry friction and its compensation are constant torques, which have no part in the loop: controller and
    arm are taken without it. An arm that the hub's friction holds cannot become unstable.

    Args:
        make: makes the controller for an arm.
        arm: driven; its dead time counts to the loop.

    Raises:
        InputError: for a loop that is not stable.

    Examples:
        >>> from flexarm_env.controllers import make_controller
        >>> found = margins_of(lambda arm: make_controller("pd", arm, 0.005), Arm.load("thesis"))
        >>> round(found.phase), round(1e3 * found.delay)
        (65, 6)
    """
    free = arm
    for effect in DRY_FRICTION:
        free = free.without_effect(effect)
    controller = make(free)
    found = [region_margins(controller, free, speed) for speed in controller.regions]
    return Margins(
        gain=min(each.gain for each in found),
        less_gain=max(each.less_gain for each in found),
        phase=min(each.phase for each in found),
        delay=min(each.delay for each in found),
        modulus=min(each.modulus for each in found),
    )


def region_margins(controller: Controller, arm: Arm, speed: float) -> Margins:
    """Compute the margins about a motor speed [rad/s].

    Raises:
        InputError: for a loop that is not stable.
    """
    response = sensitivity(controller, arm, speed)
    points = max(POINTS, 2 ** math.ceil(math.log2(len(response))))
    spectrum = np.fft.rfft(response, points)[1:]
    rates = 2.0 * np.pi * np.arange(1, len(spectrum) + 1) / (points * controller.interval)
    return margins_from(rates, 1.0 / spectrum - 1.0, float(1.0 / np.abs(spectrum).max()))


def margins_from(rates: Floats, loop: NDArray[np.complex128], modulus: float) -> Margins:
    """Read the margins off the frequency response of a loop.

    Args:
        rates: (points,) rising [rad/s].
        loop: (points,) complex.
        modulus: least distance from −1.
    """
    size = np.log(np.abs(loop))
    at, share = _crossings(size)
    lag = np.mod(_between(np.unwrap(np.angle(loop)), at, share) + np.pi, 2.0 * np.pi)
    crossed = _between(rates, at, share)
    real, share_real = _crossings(loop.imag)
    gains = -1.0 / _between(loop.real, real, share_real)
    gains = gains[gains > 0.0]
    return Margins(
        gain=float(min(gains[gains > 1.0], default=math.inf)),
        less_gain=float(max(gains[gains < 1.0], default=0.0)),
        phase=float(np.rad2deg(min(np.minimum(lag, 2.0 * np.pi - lag), default=math.inf))),
        delay=float(min(lag / crossed, default=math.inf)),
        modulus=modulus,
    )


def _crossings(values: Floats) -> tuple[NDArray[np.int64], Floats]:
    """Locate the changes of sign: the points before, and the shares of the way to the next."""
    at = np.flatnonzero(np.sign(values[:-1]) != np.sign(values[1:]))
    return at, values[at] / (values[at] - values[at + 1])


def _between(values: Floats, at: NDArray[np.int64], share: Floats) -> Floats:
    return values[at] + share * (values[at + 1] - values[at])


def sensitivity(controller: Controller, arm: Arm, speed: float = 0.0) -> Floats:
    """Compute the command's response to an impulse added to it, over the impulse: (samples,), 1 in an open loop.

    Two equal arms are driven from rest; one gets the impulse, and the difference of the commands is the response.

    Args:
        controller: of the loop.
        arm: linear, moving.
        speed: of the motor [rad/s], about which the readings are.

    Raises:
        InputError: for a loop in which the response does not end.
    """
    model, late = linearise(arm, "moving", controller.interval), _late(arm, controller.interval)
    base = np.append(model.offset, 0.0)
    base[model.outputs.index("motor_speed")] += speed
    impulse = IMPULSE * (controller.limit if controller.limit > 0.0 else 1.0)
    state, response = np.zeros(len(model.states)), np.zeros(LONGEST)
    sent = [0.0] * (len(late.responses) + late.samples)  # commands, the latest first
    controller.reset(2)
    seen = np.array([base, base])
    for k in range(LONGEST):
        seen[1, :-1] = base[:-1] + model.output @ state
        commands = controller.act(seen)
        response[k] = (commands[1] - commands[0]) / impulse + (k == 1)
        sent = [response[k] * impulse, *sent[:-1]]
        state = model.transition @ state + late.responses.T @ sent[late.samples :]
        if not np.isfinite(response[k]) or abs(response[k]) > 1.0 / ENDED:
            break
        if (
            k % STRETCH == STRETCH - 1
            and np.abs(response[k - STRETCH + 1 : k + 1]).max() < ENDED * np.abs(response[: k + 1]).max()
        ):
            return response[1 : k + 1]
    raise InputError(f"the loop of {type(controller).__name__} and arm '{arm.name}' is not stable: it has no margins")


@dataclass(frozen=True)
class Late:
    """The effect of held commands on an arm that receives them late.

    Attributes:
        samples: whole samples of the delay.
        responses: (1 or 2, states) to the command of so many samples ago, and to the one before in the rest of the delay.
    """

    samples: int
    responses: Floats


def _late(arm: Arm, interval: float) -> Late:
    """Split the arm's dead time into whole samples and a rest, in which the command before still acts."""
    delay = arm.structure().input_delay
    samples = int(delay / interval)
    rest = delay - samples * interval
    if min(rest, interval - rest) < SAME_INSTANT * interval:
        model = linearise(arm, "moving", interval)
        return Late(round(delay / interval), model.response[:, :1].T)
    first, then = linearise(arm, "moving", rest), linearise(arm, "moving", interval - rest)
    return Late(samples, np.array([then.response[:, 0], then.transition @ first.response[:, 0]]))
