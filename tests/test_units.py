"""Text with units to plain SI numbers."""

from __future__ import annotations

import logging

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env import units
from flexarm_env.errors import InputError


@pytest.mark.parametrize(
    ("value", "target", "expected"),
    [
        ("0.0116 rad", "rad", 0.0116),
        ("300g", "kg", 0.3),
        (".5", "kg", 0.5),
        (2, "kg", 2.0),
        ("3 mNm", "N*m", 0.003),
        ("3 Nm", "N*m/rad", 3.0),
        ("0.02 Nms/rad", "N*m*s/rad", 0.02),
        ("12 m/s²", "m/s**2", 12.0),
        ("9.0 1/rad", "1/rad", 9.0),
        ("3 1/ms", "1/s", 3000.0),
        ("0.02 rad/(N m)", "rad/N/m", 0.02),
        ("2 N*m/(rad/s)^2", "N*m*s**2/rad**2", 2.0),
        ("0.5 V*s/rad", "Nm/A", 0.5),
        ("3 rev/s", "rad/s", 6.0 * np.pi),
        ("90 rev/min", "rad/s", 3.0 * np.pi),
        ("0.02 N*m*s**2/rad", "kg*m**2", 0.02),
        ("2 V", "V/rad", 2.0),
    ],
)
def test_quantities(value: str | float, target: str, expected: float) -> None:
    assert units.quantity(value, target) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "number", "unit"),
    [
        ("12 V", 12.0, "V"),
        ("4200 mohm", 4.2, "ohm"),
        ("9 mV/mrad", 9.0, "V/rad"),
        ("0.1 V*s/rad", 0.1, "V*s/rad"),
        ("300 g", 0.3, "kg"),
        ("30 g cm^2", 3e-6, "kg*m**2"),
        ("3 1/ms", 3000.0, "1/s"),
        ("2 min", 120.0, "s"),
        ("3 turn", 6.0 * np.pi, "rad"),
        ("20 degC", 293.15, "K"),
    ],
)
def test_a_base_value_keeps_a_unit_that_a_person_writes(text: str, number: float, unit: str) -> None:
    found = units.base_value(text)
    assert (found, found.unit) == (pytest.approx(number, rel=1e-12), unit)
    again = units.base_value(f"{float(found)!r} {found.unit}")
    assert (again, again.unit) == (found, found.unit)


def test_making_the_registry_warns_of_nothing(caplog):
    with caplog.at_level(logging.DEBUG):
        registry = units._registry.__wrapped__()
    assert [r.getMessage() for r in caplog.records if r.levelno >= logging.WARNING] == []
    assert registry.Quantity(1.0, "Nm").to("kg*m**2/s**2").magnitude == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("value", "target"),
    [
        ("", "kg"),
        ("kg", "kg"),
        ("1e999 kg", "kg"),
        ("1 V", ""),
        ("4e", "C"),
        ("4e-", "C"),
        ("5 V/Hz", "V*s/rad"),
        ("5 V/deg", "V"),
        ("5 V/rad", "V"),
        ("5 N*m/deg", "N*m"),
        ("5 N*m*deg", "N*m"),
        ("20 degC", "K"),
        ("3 kg kg", "kg"),
        ("2 000", "kg"),
        ("2 000 kg", "kg"),
        ("9.01/rad", "1/rad"),
        ("1 (m**9)**9**9", "m"),
        ("1" + 200_000 * " " + ".", "kg"),
        ("1 k" + 200_000 * " " + "g", "kg"),
        (200_000 * "1" + ":", "kg"),
    ],
)
def test_quantities_that_are_refused(value: str, target: str) -> None:
    with pytest.raises(InputError):
        units.quantity(value, target)


@given(st.text(max_size=20))
def test_any_text_is_a_unit_or_refused(text: str) -> None:
    message = ""
    try:
        assert np.isfinite(units.factor(text, "rad"))
    except InputError as error:
        message = str(error)
    assert message.isprintable()
