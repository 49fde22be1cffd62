"""The page of a task's environment, in Gymnasium's headings: a common text, the task's own paragraphs, and its numbers."""

from __future__ import annotations

import math

from flexarm_env.tasks import CONTROL_RATE, RANDOM_PAYLOAD, Task

PAGE = """{summary}

## Description

A motor turns a slender beam through gears whose friction sticks and slips (B. McDonald, *Modeling and Control of a
Flexible-Link Manipulator*). While the hub moves, the beam is nearly pinned; once the hub sticks, the beam is clamped and
rings on with little damping. The agent observes a pot, a tachometer and two strain gages, never the state.

{description}

## Action Space

A `Box(-1, 1, (1,), float32)`: the current command as a share of the drive's limit (5 A for the thesis's arm; V where
the arm is driven by a voltage). It is held for one control step of {step:g} ms; beyond ±1 it is clipped.

## Observation Space

A `Box` of shape (signals + 1,), float32: the readings of the rig, in the order of the arm file, then the target.
Noise, steps, delays and filters are those of the arm's sensors; the state itself is in `info` only. Readings end where
the rig's converters do.

| Num | Observation (thesis's arm) | Largest | Unit with `physical=True` | Divided by otherwise |
|-----|----------------------------|---------|---------------------------|----------------------|
| 0   | `arm_angle`, pot           | 4 π     | rad                       | π                    |
| 1   | `motor_speed`, tachometer  | 200     | rad/s, motor side         | 5                    |
| 2   | `strain_mid`, gage         | 10      | V                         | 2                    |
| 3   | `strain_base`, gage        | 10      | V                         | 2                    |
| 4   | target angle               | 4 π     | rad                       | π                    |

## Rewards

The sum of the terms below, each times its weight and in `info` under its name. θ is the hub's true angle, w the tip's true
deflection, u the command over its limit.

{rewards}

`info` also holds `hub_angle`, `hub_speed`, `tip_deflection`, `stuck`, `target` and `command`, in SI units.

## Starting State

{start}

`reset(options={{"state": x, "target": angle}})` starts at another physical state, as `env.unwrapped.state().physical` has it, and
with another target. `env.unwrapped.set_state(state)` goes back to a state that `env.unwrapped.state()` returned, bit for bit.

## Episode End

1. Termination: {termination}
2. Truncation: after {duration:g} s, {steps} steps of {step:g} ms.

## Arguments

`arm` (name, arm file or `Arm`; the corrected arm that `flexarm diagnose --save` writes as well), `prior`, `randomise`,
`vary`, `goals`, `disturb`, `control_rate`, `duration`, `physical`, `render_mode`: see `FlexArmEnv`. `FlexArm/{title}-Random-v0`
carries an unknown payload of {lightest:g} to {heaviest:g} kg at its tip, `FlexArm/{title}-Goal-v0` has another target (`goals`),
both drawn anew for each episode. `FlexArm/{title}-Shaped-v0` has the observation, action and reward of the shipped policies.

```python
>>> import gymnasium as gym
>>> import flexarm_env
>>> env = gym.make("FlexArm/{title}-v0", physical=True, randomise={{"payload.mass": (0.0, 0.3)}}, vary={{"coulomb.torque": 0.2}})
>>> observation, info = env.reset(seed=7)
>>> observation.shape, sorted(info)[:3]
((5,), ['command', 'hub_angle', 'hub_speed'])
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
>>> terminated, truncated
(False, False)
>>> env.close()

```

## Version History

* v0: first version
"""


def page_of(task: Task) -> str:
    """Write the page of a task's environment, in Markdown."""
    return PAGE.format(
        summary=task.summary or f"A flexible arm at the task {task.name}.",
        description=task.description.strip(),
        title=task.title,
        rewards=_rewards(task),
        start=_start(task),
        termination=_termination(task),
        steps=task.steps(),
        step=1000.0 / CONTROL_RATE,
        duration=task.duration,
        lightest=RANDOM_PAYLOAD[0],
        heaviest=RANDOM_PAYLOAD[1],
    )


def _rewards(task: Task) -> str:
    rows = [("Term in `info`", "Weight", "Value")]
    rows += [(f"`reward_{term.name}`", f"{task.weight(term):g}", term.formula.replace("|", "\\|")) for term in task.terms]
    widths = [max(len(row[i]) for row in rows) for i in range(3)]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |" for row in rows]
    return "\n".join([lines[0], "|" + "|".join("-" * (width + 2) for width in widths) + "|", *lines[1:]])


def _start(task: Task) -> str:
    angle, target = _degrees(task.angle), _degrees(task.target)
    if task.pulse and task.pulse_time:
        start = f"At rest at angle {angle}; then a pulse of {task.pulse:g} times the drive's limit for {task.pulse_time:g} s"
        start += f", and {task.coast:g} s without a command: there the episode starts."
    else:
        start = f"At rest at angle {angle}."
    if task.hold:
        return f"{start} The target is the angle where the hub is then."
    changes = f", and changes its sign every {task.half_period:g} s" if task.half_period else ""
    return f"{start} The target is {target}{changes}."


def _termination(task: Task) -> str:
    if math.isinf(task.range):
        return "only where the arm's numbers are no longer finite; the hub may turn as far as it will."
    return f"the hub is more than {_degrees(task.range)} from where it started."


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.4g}°"
