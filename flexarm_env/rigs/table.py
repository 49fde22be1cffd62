"""The rigs: which recordings train, which are held out, and the published figure of each."""

from __future__ import annotations

from flexarm_env.rigs.inverse import Recipe
from flexarm_env.rigs.metric import AngleError, CommandError, SignalFit
from flexarm_env.rigs.rig import Published, Record, Rig

_CU = "University of Colorado Boulder, ASEN 2003 laboratory 6 (2017)"
_PENDULUM = "multiarm_pendulum/SinglePendulumDataForParameterEstimation.mat"


def _boulder(run: str) -> Record:
    return Record(f"cu_boulder/BenHagenau_{run}.txt", run)


def _swing(cells: str, number: int) -> Record:
    return Record(_PENDULUM, f"{cells} {number}", {"_id{1}": f"_{cells}{{{number}}}"})


def _servo(time: str) -> Record:
    return Record(f"bam_xl330/2026-01-15_{time}.json", time)


RIGS: tuple[Rig, ...] = (
    Rig(
        name="emps",
        title="carriage on a ball screw",
        source="Janot, Gautier, Brunot, EMPS, Workshop on Nonlinear System Identification Benchmarks (2019)",
        arm="emps",
        training=(Record("emps/DATA_EMPS.mat"),),
        held_out=(Record("emps/DATA_EMPS_PULSES.mat"),),
        metric=CommandError(Recipe(angle=100.0, dropped=49, decimation=10)),
        published=(Published("symmetric friction", 5.9824), Published("asymmetric viscous friction", 5.36)),
        goal=5.36,
    ),
    Rig(
        name="cu-rigid",
        title="rotary arm of a student laboratory, rigid",
        source=_CU,
        arm="cu-rigid",
        training=(_boulder("rigidarm_K1_6"),),
        held_out=(_boulder("rigidarm_K1_8"),),  # the law of rigidarm_k1k3_6 misses its voltage by 16 %
        metric=SignalFit("arm_angle", closed=True),
        published=(Published("independent study: Coulomb friction and an offset, fitted to this record", 94.0),),
        goal=95.0,
    ),
    Rig(
        name="cu-flexible",
        title="rotary arm of a student laboratory, flexible",
        source=_CU,
        arm="cu-flexible",
        training=(_boulder("flexarm_K1_6"), _boulder("flexarm_k1k2_6_-3")),
        held_out=(_boulder("flexarm_K1K2_6_-5"),),
        metric=SignalFit("arm_angle"),
        published=(Published("independent study: Coulomb friction and an offset", 81.0),),
        goal=88.0,
    ),
    Rig(
        name="ur10e",
        title="base joint of an industrial robot",
        source="Mamedov, dynamic_calibration: joint 1 of a UR10e",
        arm="ur10e-joint1",
        training=(Record("ur10e/joint_1.csv", "second half", start=0.5),),  # it ends at rest, which shows dry friction
        held_out=(Record("ur10e/joint_1.csv", "first half", stop=0.5),),
        metric=CommandError(Recipe(both=5.0, at_rest=0.005), "A"),
        published=(
            Published("regression in sample: inertia", 2.71),
            Published("and viscous friction", 0.613),
            Published("and Coulomb friction", 0.184),
            Published("with viscous friction like a square root", 0.170),
        ),
        goal=0.170,
    ),
    Rig(
        name="dfki",
        title="torque-driven pendulum under gravity",
        source="DFKI, torque_limited_simple_pendulum",
        arm="dfki-pendulum",
        training=(Record("dfki_pendulum/ddp.csv"),),
        held_out=(Record("dfki_pendulum/pd_identification.csv"),),  # no constants give the torque of energy_shaping
        metric=CommandError(Recipe(angle=20.0, both=5.0), "Nm"),
        published=(Published("identification of the publisher, by this measure", 0.558),),
    ),
    Rig(
        name="multiarm",
        title="pendulum that swings freely",
        source="Kaheman and others, MultiArm-Pendulum",
        arm="multiarm-pendulum",
        training=tuple(_swing("id", number) for number in range(1, 5)),
        held_out=tuple(_swing("vad", number) for number in range(1, 3)),
        metric=AngleError(),
    ),
    Rig(
        name="xl330",
        title="small servo with a pendulum",
        source="Rhoban, bam: XL330, logs of January 2026",
        arm="xl330-pendulum",
        training=tuple(map(_servo, ("10h28m10", "10h28m24", "10h29m47", "10h30m02"))),  # firmware gains 100 and 800
        held_out=tuple(map(_servo, ("10h28m42", "10h28m57", "10h29m14", "10h29m29"))),  # 200 and 400
        metric=AngleError(mean_absolute=True),
        published=(
            Published("viscous and Coulomb friction (M1), on sixteen logs", 0.0819),
            Published("and Stribeck friction (M2)", 0.0812),
            Published("with load dependence (M3)", 0.0691),
        ),
        goal=0.055,
    ),
)
