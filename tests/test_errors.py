"""Messages of bad input are one line that a person can read, whatever they quote."""

from __future__ import annotations

import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from flexarm_env.errors import InputError, UnknownArgument


@given(text=st.text())
def test_an_error_is_one_printable_line_and_passes_between_processes(text: str) -> None:
    for kind in (InputError, UnknownArgument):
        line = str(kind(text))
        assert line.isprintable()
        assert str(pickle.loads(pickle.dumps(kind(text)))) == line


@pytest.mark.parametrize("text", ["gain 'Kp_µ' is 3 Nm/°; give 0 to 1", ""])
def test_a_line_that_is_printable_stays_as_it_is(text: str) -> None:
    assert str(InputError(text)) == text


def test_what_cannot_be_printed_is_escaped() -> None:
    assert str(InputError("unknown key 'auth\x7frity'\n")) == r"unknown key 'auth\x7frity'\n"
