"""A beam in its slowest vibrations: those that no reading shows cost a replay as much as any other.

The motion of the beam against a held hub is expanded in its vibrations there, the slowest of which are kept (component mode
synthesis: Craig and Bampton, AIAA J. 6 (1968) 1313).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.linalg import block_diag, eigh

from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.structure import LinearModel

#: Coordinates that are no part of the beam's motion against its hub.
BODIES = frozenset({"hub", "motor", "fixture"})


def beam_coordinates(model: LinearModel) -> slice:
    """Locate the beam's coordinates, the root's among them: the last ones."""
    return slice(sum(name in BODIES for name in model.names), len(model.names))


def slowest_shapes(model: LinearModel, count: int) -> Matrix:
    """Compute the shapes (beam coordinates, count) of the beam's slowest vibrations against a held hub, of unit mass.

    Each moves the tip to the positive side.
    """
    beam = beam_coordinates(model)
    _, shapes = eigh(model.stiffness[beam, beam], model.mass[beam, beam], subset_by_index=[0, count - 1])
    return np.asarray(shapes * np.where(model.tip[beam] @ shapes < 0.0, -1.0, 1.0))


def reduce_beam(model: LinearModel, count: int) -> LinearModel:
    """Keep the slowest vibrations of the beam of one arm; all coordinates, where there are no more than those.

    Args:
        model: the matrices.
        count: vibrations to keep.
    """
    beam = beam_coordinates(model)
    if len(model.names) - beam.start <= count:
        return model
    shapes = slowest_shapes(model, count)
    across = block_diag(np.eye(beam.start), shapes)
    motion = block_diag(across, across)
    state = block_diag(motion, np.eye(len(model.extra)))
    return replace(
        model,
        names=[*model.names[: beam.start], *(f"vibration_{k + 1}" for k in range(count))],
        mass=across.T @ model.mass @ across,
        damping=across.T @ model.damping @ across,
        stiffness=across.T @ model.stiffness @ across,
        input=across.T @ model.input,
        from_extra=across.T @ model.from_extra,
        extra_from_motion=model.extra_from_motion @ motion,
        output=model.output @ state,
        beam_force=across.T @ model.beam_force,
        beam_velocity=model.beam_velocity @ across,
        settled=model.settled @ motion,
        tip=model.tip @ across,
    )


def reduce_state(model: LinearModel, state: Matrix, count: int) -> Matrix:
    """Project a state [q, q̇, e] (states,) of a whole model onto the slowest vibrations of its beam."""
    beam, size = beam_coordinates(model), len(model.names)
    if size - beam.start <= count:
        return state
    across = slowest_shapes(model, count).T @ model.mass[beam, beam]
    moved = [part for half in (state[:size], state[size : 2 * size]) for part in (half[: beam.start], across @ half[beam])]
    return np.concatenate([*moved, state[2 * size :]])
