"""Uses two new signals as a person would; sys.argv[1] is the folder that holds their files under sensors/."""

from __future__ import annotations

import contextlib
import io
import json
import sys
from pathlib import Path

import gymnasium as gym
import numpy as np

import flexarm_env.sensors
from flexarm_env.errors import InputError

FOLDER = Path(sys.argv[1])
flexarm_env.sensors.__path__.append(str(FOLDER / "sensors"))

from flexarm_env import Arm, Recording, compare, fit, simulate  # noqa: E402
from flexarm_env.arm_file import shipped_arms  # noqa: E402
from flexarm_env.cli import run  # noqa: E402

OWN = "\n[sensors.shaft_acceleration]\n\n[sensors.tip_speed]\n\n[sensors.tip_deflection]\n"


def arm_with(name: str, extra: str) -> Arm:
    path = FOLDER / f"{name}-own.toml"
    path.write_text(shipped_arms()[name].read_text(encoding="utf-8") + extra, encoding="utf-8")
    return Arm.load(path)


def rigid() -> dict:
    """A pulse on a rigid arm with Coulomb friction alone."""
    arm = arm_with("cu-rigid", "\n[sensors.shaft_acceleration]\n")
    for effect in arm.effects:
        arm = arm.without_effect(effect)
    arm = arm.with_effect("coulomb", torque=0.02)
    drive = arm.constants["drive"]
    arm = arm.with_values({"sensors.shaft_acceleration.filter": 5e-4})
    commands = np.where(np.arange(400) < 100, 3.0, 0.0)
    plant = arm.plant(1e-3)
    plant.place()
    place = plant.signals.index("shaft_acceleration")
    readings = plant.replay(commands)[:, place]
    # the back-EMF slows it, so the speed at that moment counts
    plant.place()
    plant.replay(commands[:61])
    speed = plant.physical()[1]
    turns = drive["gear_ratio"] * drive["torque_constant"] / drive["resistance"]
    motor = turns * (3.0 - drive["gear_ratio"] * drive["torque_constant"] * speed)
    inertia = arm.constants["hub"]["inertia"] + drive["gear_ratio"] ** 2 * drive["motor_inertia"]
    # a filter of 0.5 ms follows the slow decay of the back-EMF with its lag
    decay = turns * drive["gear_ratio"] * drive["torque_constant"] / inertia
    now = (motor - 0.02) / inertia
    return {"sliding": float(readings[60]), "expected acceleration": now / (1.0 - 5e-4 * decay), "stuck": float(readings[-1])}


def sampling(arm: Arm) -> dict:
    """The same commands in steps of 5 ms and of 0.5 ms."""
    commands = 3.0 * np.sign(np.sin(8.0 * np.arange(300) * 5e-3))
    plants = [arm.plant(5e-3), arm.plant(5e-4)]
    for plant in plants:
        plant.place()
    column = plants[0].signals.index("shaft_acceleration")
    coarse, fine = plants[0].replay(commands), plants[1].replay(np.repeat(commands, 10))[::10]
    return {"coarse": coarse[:, column].tolist(), "fine": fine[:, column].tolist()}


def recordings(arm: Arm) -> dict:
    made = simulate(arm, "square", duration=4.0, rate=250.0)
    made.write(FOLDER / "made.csv")
    again = Recording.read(FOLDER / "made.csv")
    found = {
        "header": (FOLDER / "made.csv").read_text(encoding="utf-8").splitlines()[0],
        "same again": all(again.signals[s].tobytes() == made.signals[s].tobytes() for s in arm.signals),
    }
    clean = simulate(arm, "square", duration=2.0, rate=1000.0, noise=False).signals
    absolute = clean["arm_angle"] * arm.value("beam.length") + clean["tip_deflection"]
    found["tip speed"] = clean["tip_speed"][1:-1].tolist()
    found["tip speed from angle and deflection"] = ((absolute[2:] - absolute[:-2]) / 2e-3).tolist()
    result = compare(arm, [again])
    found |= {"compare": result.error, "compared": list(result.noise)}
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        assert run(["compare", str(FOLDER / "made.csv"), "--arm", str(FOLDER / "thesis-own.toml")]) == 0
    found["table"] = said.getvalue()
    late = slice(137, None)
    moving = Recording.from_arrays(
        "moving", again.time[late], "current", again.command[late], {s: v[late] for s, v in again.signals.items()}
    )
    return found | {"compare from motion": compare(arm, [moving]).error}


def fits(arm: Arm) -> dict:
    arm = arm.with_effect("sensor_offset", **dict.fromkeys(arm.known["sensor_offset"].parameters, 0.0))
    other = arm.with_values({"sensors.tip_speed.gain": 1.1, "effects.sensor_offset.tip_speed": 0.3})
    found = fit(arm, [simulate(other, "square", duration=3.0, rate=200.0)], jobs=1).arm.fitted
    return {"gain": found["sensors.tip_speed.gain"], "offset": found["effects.sensor_offset.tip_speed"]}


def observations(arm: Arm) -> dict:
    env = gym.make("FlexArm/Slew-v0", arm=arm, physical=True)
    seen = [env.reset(seed=1)[0]] + [env.step(np.ones(1, np.float32))[0] for _ in range(20)]
    place = arm.signals.index("shaft_acceleration")
    return {
        "observation": list(env.observation_space.shape),
        "bounds": env.observation_space.high[[place, arm.signals.index("tip_speed")]].tolist(),
        "observed acceleration": float(np.abs([row[place] for row in seen]).max()),
    }


def refusals() -> dict:
    found = {}
    try:
        arm_with("cu-rigid", "\n[sensors.tip_speed]\n")
    except InputError as error:
        found["refused"] = str(error)
    (FOLDER / "bare.csv").write_text("time [s],current [A],tip_speed\n0,0,0\n1,0,0\n", encoding="utf-8")
    try:
        Recording.read(FOLDER / "bare.csv")
    except InputError as error:
        found["no unit"] = str(error)
    return found


def main() -> None:
    arm = arm_with("thesis", OWN.replace("[sensors.tip_deflection]", '[sensors.tip_deflection]\nnoise = "1 mm"'))
    found = rigid() | sampling(arm) | recordings(arm) | fits(arm) | observations(arm) | refusals()
    (FOLDER / "found.json").write_text(json.dumps(found), encoding="utf-8")


main()
