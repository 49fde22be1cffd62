"""The thesis's arm as a user of MuJoCo would write it: rigid segments on joints with springs, made from its numbers."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from flexarm_env import Arm

Array = NDArray[np.float64]

SEGMENTS = 4
STEP = 0.001
#: MuJoCo's dry friction is a soft constraint: its hub creeps under any torque. These are its stiffest values that are
#: still well posed at STEP: a time constant of two steps, and the largest impedance that it takes.
STIFF = {"solreffriction": f"{2 * STEP} 1", "solimpfriction": "0.9999 0.9999 0.001"}
#: A torque that the arm's friction holds, as a share of its Coulomb torque, and how long [s].
PUSH, HELD = 0.7, 5.0


def installed() -> bool:
    """Whether MuJoCo is installed."""
    return find_spec("mujoco") is not None


def mjcf(arm: Arm, friction: dict[str, str]) -> str:
    """Write the arm as MJCF; a segment's spring is the bending stiffness over its length, over half of it at the hub."""
    beam, drive = arm.constants["beam"], arm.constants["drive"]
    h = beam["length"] / SEGMENTS
    mass = beam["mass_per_length"] * h
    across, along = mass * h**2 / 12, 1e-6
    armature = drive["gear_ratio"] ** 2 * drive["motor_inertia"] + arm.constants["hub"]["inertia"]
    soft = " ".join(f'{key}="{value}"' for key, value in friction.items())
    body = ""
    for i in reversed(range(SEGMENTS)):
        stiffness = beam["bending_stiffness"] / h * (1.0 if i else 2.0)
        body = (
            f'<body pos="{h if i else 0.0} 0 0"><joint name="bend{i}" type="hinge" axis="0 0 1" stiffness="{stiffness}"/>'
            f'<inertial pos="{h / 2} 0 0" mass="{mass}" diaginertia="{along} {across} {across}"/>{body}</body>'
        )
    return f"""<mujoco>
  <option timestep="{STEP}" gravity="0 0 0" integrator="implicitfast"><flag contact="disable"/></option>
  <worldbody><body>
    <joint name="hub" type="hinge" axis="0 0 1" armature="{armature}" damping="{arm.effects["viscous"]["coefficient"]}"
      frictionloss="{arm.effects["coulomb"]["torque"]}" {soft}/>
    <inertial pos="0 0 0" mass="0.001" diaginertia="1e-6 1e-6 1e-6"/>{body}
  </body></worldbody>
  <actuator><motor joint="hub" gear="{drive["gear_ratio"] * drive["torque_constant"]}" ctrlrange="-5 5"/></actuator>
  <sensor><jointpos joint="hub"/><jointvel joint="hub"/><jointpos joint="bend0"/><jointpos joint="bend2"/></sensor>
</mujoco>"""


class Rollouts:
    """Many arms at rest, integrated by mujoco.rollout on one thread."""

    def __init__(self, arm: Arm, count: int, friction: dict[str, str] | None = None) -> None:
        import mujoco
        from mujoco import rollout

        self.arm, self.run = arm, rollout.rollout
        self.model: Any = mujoco.MjModel.from_xml_string(mjcf(arm, STIFF if friction is None else friction))
        self.data: Any = mujoco.MjData(self.model)
        start = np.zeros(mujoco.mj_stateSize(self.model, mujoco.mjtState.mjSTATE_FULLPHYSICS))
        mujoco.mj_getState(self.model, self.data, start, mujoco.mjtState.mjSTATE_FULLPHYSICS)
        self.start = np.tile(start, (count, 1))

    def roll(self, commands: Array) -> Array:
        """Simulate readings (arms, steps, sensors) under commands (arms, steps) [A]."""
        _, readings = self.run(self.model, self.data, self.start, commands[:, :, None])
        return readings

    def creep(self) -> float:
        """Measure the angle [rad] by which a push below static friction moves the settled hub."""
        drive = self.arm.constants["drive"]
        push = PUSH * self.arm.effects["coulomb"]["torque"] / (drive["gear_ratio"] * drive["torque_constant"])
        angle = self.roll(np.full((len(self.start), round(2 * HELD / STEP)), push))[0, :, 0]
        return float(abs(angle[-1] - angle[len(angle) // 2]))
