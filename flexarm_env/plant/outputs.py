"""The sensors in the linear model: rows of the output, and states of filters."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from flexarm_env.errors import InputError
from flexarm_env.plant.beam import Matrix
from flexarm_env.plant.reading import Channel, Coordinates, Reading, time_constant
from flexarm_env.plant.structure import COMMAND, DRIVERS, ONE, SHORTEST_LAG, LinearModel, Structure, exceeds


def add_sensors(s: Structure, model: LinearModel, coordinates: Coordinates) -> None:
    """Add the rows of the sensors to a linear model, and the states of their filters."""
    size, arms = len(model.names), model.mass.shape[:-2]
    readings = [_reading(signal, channel, coordinates) for signal, channel in s.sensors.items()]
    filters = [time_constant(reading, channel) for reading, channel in zip(readings, s.sensors.values(), strict=True)]
    filtered = [i for i, filter in enumerate(filters) if exceeds(filter, SHORTEST_LAG)]
    before = model.extra.shape[-1]
    _make_room(model, before + len(filtered))
    model.output = np.zeros((*arms, len(s.sensors), 2 * size + before + len(filtered)))
    model.output_from_input = np.zeros((*arms, len(s.sensors), len(DRIVERS)))
    model.signals = list(s.sensors)
    for i, (reading, channel) in enumerate(zip(readings, s.sensors.values(), strict=True)):
        # a filter behind a reading that jumps stores it without gain, so that the gain moves no rounding error of the motion
        inner, outer = (1.0, channel.gain) if reading.jumps else (channel.gain, 1.0)
        row = _row(reading, np.zeros((*arms, 2 * size))) * np.asarray(inner)[..., None]
        model.output_from_input[..., i, ONE] = channel.offset
        if i in filtered:
            _add_filter(model, i, before + filtered.index(i), reading, row, filters[i], outer)
        else:
            model.output[..., i, : 2 * size] = row


def _make_room(model: LinearModel, total: int) -> None:
    """Widen a model to so many states beyond positions and speeds."""
    size = len(model.names)
    model.extra = _grown(model.extra, total, total)
    model.from_extra = _grown(model.from_extra, size, total)
    model.extra_from_motion = _grown(model.extra_from_motion, total, 2 * size)
    model.extra_from_input = _grown(model.extra_from_input, total, len(DRIVERS))
    model.settled = _grown(model.settled, total, 2 * size)


def _row(reading: Reading, row: Matrix) -> Matrix:
    """Write a reading of positions, speeds and the motor's current into a row of zeros."""
    size = row.shape[-1] // 2
    if reading.position is not None:
        row[..., :size] = reading.position
    if reading.speed is not None:
        row[..., size:] = reading.speed
    if reading.current is not None:
        row[..., :size] += reading.current.position
        row[..., size:] += reading.current.speed
    return row


def _add_filter(
    model: LinearModel, i: int, place: int, reading: Reading, row: Matrix, time: float | Matrix, outer: float | Matrix
) -> None:
    """Put a filter behind a reading.

    Args:
        model: the model, with room for the filter's state.
        i: index of the signal.
        place: index of the state.
        reading: what is filtered.
        row: of the reading, which the filter stores.
        time: time constant [s].
        outer: gain behind the filter.
    """
    size = len(model.names)
    if reading.acceleration is not None:
        # A filtered acceleration is linear in the state: the speed less the filtered speed, over the time constant.
        rate = reading.acceleration * np.asarray(1.0 / time)[..., None]
        row[..., size:] -= rate
        model.output[..., i, size : 2 * size] = rate * np.asarray(outer)[..., None]
        model.settled[..., place, :] = row
    if reading.current is not None:
        model.settled[..., place, :] = row
        model.extra_from_input[..., place, COMMAND] = reading.current.command / time
        if reading.current.lagged:
            model.extra[..., place, 0] = 1.0 / time
    model.extra[..., place, place] = -1.0 / time
    model.extra_from_motion[..., place, :] = row / np.asarray(time)[..., None]
    model.output[..., i, 2 * size + place] = outer


def _reading(signal: str, channel: Channel, coordinates: Coordinates) -> Reading:
    try:
        return channel.reading(replace(coordinates, position=channel.position))
    except InputError as error:
        raise InputError(f"sensors.{signal} {error}") from None


def _grown(matrix: Matrix, rows: int, columns: int) -> Matrix:
    """Pad matrices with zeros below and to the right."""
    grown = np.zeros((*matrix.shape[:-2], rows, columns))
    grown[..., : matrix.shape[-2], : matrix.shape[-1]] = matrix
    return grown
