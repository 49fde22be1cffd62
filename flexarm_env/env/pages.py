"""The three tasks as environments: their docstrings are their pages."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flexarm_env.arm import Arm
from flexarm_env.env.flexarm import FlexArmEnv
from flexarm_env.errors import InputError


def refuse_task(own: str, arguments: Mapping[str, Any]) -> None:
    """Refuse another task than a page's own.

    Raises:
        InputError: naming both.
    """
    if "task" in arguments:
        raise InputError(f"task = {arguments['task']!r}: this environment's task is '{own}'; use FlexArmEnv for another")


class SlewEnv(FlexArmEnv):
    """Slew a flexible arm from rest to rest over 100°.

    ## Description

    A motor turns a slender beam through gears whose friction sticks and slips (B. McDonald, *Modeling and Control of a
    Flexible-Link Manipulator*). While the hub moves the beam is as good as pinned; once it sticks it is clamped and rings on
    with next to no damping. Bring the arm to 100° fast, and leave it still. The agent sees a pot, a tachometer and two
    strain gages, never the state.

    ## Action Space

    A `Box(-1, 1, (1,), float32)`: the current command as a share of the drive's limit (5 A for the thesis's arm; V where
    the arm is driven by a voltage). It is held for one control step of 5 ms; beyond ±1 it is clipped.

    ## Observation Space

    A `Box` of shape (signals + 1,), float32: what the rig measures, in the order of the arm file, then the target.
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

    The sum of the terms below, each in `info` under its name. θ is the hub's true angle, w the tip's true deflection, u
    the command over its limit.

    | Term in `info`     | Value                                             |
    |--------------------|---------------------------------------------------|
    | `reward_distance`  | −1 · abs(target − θ)                              |
    | `reward_closeness` | 0.5 · exp(−abs(target − θ) / 0.05 rad)            |
    | `reward_vibration` | −2 · abs(w) / beam length                         |
    | `reward_effort`    | −0.02 · u²                                        |
    | `reward_rate`      | −0.02 · (change of u)²                            |
    | `reward_failure`   | −100, once, where the arm leaves its range        |

    ## Starting State

    At rest at angle 0, target 100°.

    ## Episode End

    1. Termination: the hub is more than 180° from where it started.
    2. Truncation: after 1000 steps of 5 ms, 5 s.

    ## Arguments

    `arm` (name, arm file or `Arm`; the corrected arm that `flexarm diagnose --save` writes as well), `prior`, `randomise`,
    `vary`, `disturb`, `control_rate`, `physical`, `render_mode`: see `FlexArmEnv`. `FlexArm/Slew-Random-v0` carries an unknown
    payload of 0 to 0.3 kg at its tip, drawn anew for each episode.

    ```python
    >>> import gymnasium as gym
    >>> import flexarm_env
    >>> env = gym.make("FlexArm/Slew-v0", physical=True, randomise={"payload.mass": (0.0, 0.3)}, vary={"coulomb.torque": 0.2})
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

    def __init__(self, arm: str | Path | Arm = "thesis", **arguments: Any) -> None:
        refuse_task("slew", arguments)
        super().__init__("slew", arm, **arguments)


class TrackEnv(FlexArmEnv):
    """Follow a square wave of ±50° with a flexible arm.

    ## Description

    The machine of SlewEnv; the target jumps from 50° to −50° and back, every 2.5 s (0.2 Hz). Each jump excites the
    beam anew, so that what is left of the last vibration meets the next one.

    ## Action Space

    A `Box(-1, 1, (1,), float32)`: the current command as a share of the drive's limit (5 A for the thesis's arm; V where
    the arm is driven by a voltage). It is held for one control step of 5 ms; beyond ±1 it is clipped.

    ## Observation Space

    A `Box` of shape (signals + 1,), float32: what the rig measures, in the order of the arm file, then the target.
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

    The sum of the terms below, each in `info` under its name. θ is the hub's true angle, w the tip's true deflection, u
    the command over its limit.

    | Term in `info`     | Value                                             |
    |--------------------|---------------------------------------------------|
    | `reward_distance`  | −1 · abs(target − θ)                              |
    | `reward_closeness` | 0.5 · exp(−abs(target − θ) / 0.05 rad)            |
    | `reward_vibration` | −2 · abs(w) / beam length                         |
    | `reward_effort`    | −0.02 · u²                                        |
    | `reward_rate`      | −0.02 · (change of u)²                            |
    | `reward_failure`   | −100, once, where the arm leaves its range        |

    ## Starting State

    At rest at angle 0, target 50°.

    ## Episode End

    1. Termination: the hub is more than 180° from where it started.
    2. Truncation: after 2000 steps of 5 ms, 10 s.

    ## Arguments

    `arm` (name, arm file or `Arm`; the corrected arm that `flexarm diagnose --save` writes as well), `prior`, `randomise`,
    `vary`, `disturb`, `control_rate`, `physical`, `render_mode`: see `FlexArmEnv`. `FlexArm/Track-Random-v0` carries an unknown
    payload of 0 to 0.3 kg at its tip, drawn anew for each episode.

    ```python
    >>> import gymnasium as gym
    >>> import flexarm_env
    >>> env = gym.make("FlexArm/Track-v0", physical=True, randomise={"payload.mass": (0.0, 0.3)}, vary={"coulomb.torque": 0.2})
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

    def __init__(self, arm: str | Path | Arm = "thesis", **arguments: Any) -> None:
        refuse_task("track", arguments)
        super().__init__("track", arm, **arguments)


class DampEnv(FlexArmEnv):
    """Kill the vibration that a pulse has left in a flexible arm.

    ## Description

    The machine of SlewEnv, 2 s after a pulse of 3 A for 0.5 s: the hub has stuck, and the beam, clamped by it, rings on. To
    damp it the hub has to break away, work against the beam, and come to rest again where it was.

    ## Action Space

    A `Box(-1, 1, (1,), float32)`: the current command as a share of the drive's limit (5 A for the thesis's arm; V where
    the arm is driven by a voltage). It is held for one control step of 5 ms; beyond ±1 it is clipped.

    ## Observation Space

    A `Box` of shape (signals + 1,), float32: what the rig measures, in the order of the arm file, then the target.
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

    The sum of the terms below, each in `info` under its name. θ is the hub's true angle, w the tip's true deflection, u
    the command over its limit.

    | Term in `info`     | Value                                             |
    |--------------------|---------------------------------------------------|
    | `reward_distance`  | −1 · abs(target − θ)                              |
    | `reward_closeness` | 0.5 · exp(−abs(target − θ) / 0.05 rad)            |
    | `reward_vibration` | −2 · abs(w) / beam length                         |
    | `reward_effort`    | −0.02 · u²                                        |
    | `reward_rate`      | −0.02 · (change of u)²                            |
    | `reward_failure`   | −100, once, where the arm leaves its range        |

    ## Starting State

    2 s after the pulse, the beam ringing; the target is the angle where the hub stands.

    ## Episode End

    1. Termination: the hub is more than 180° from where it started.
    2. Truncation: after 1000 steps of 5 ms, 5 s.

    ## Arguments

    `arm` (name, arm file or `Arm`; the corrected arm that `flexarm diagnose --save` writes as well), `prior`, `randomise`,
    `vary`, `disturb`, `control_rate`, `physical`, `render_mode`: see `FlexArmEnv`. `FlexArm/Damp-Random-v0` carries an unknown
    payload of 0 to 0.3 kg at its tip, drawn anew for each episode.

    ```python
    >>> import gymnasium as gym
    >>> import flexarm_env
    >>> env = gym.make("FlexArm/Damp-v0", physical=True, randomise={"payload.mass": (0.0, 0.3)}, vary={"coulomb.torque": 0.2})
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

    def __init__(self, arm: str | Path | Arm = "thesis", **arguments: Any) -> None:
        refuse_task("damp", arguments)
        super().__init__("damp", arm, **arguments)
