"""No cell, row or remark is lost without a word, and no line takes time that grows faster than its length."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from recording_files import GOOD, HEADER, refusal, save
from work import ends

from flexarm_env import units
from flexarm_env.arm import Arm
from flexarm_env.errors import InputError
from flexarm_env.lab.uploads import read_upload
from flexarm_env.recordings.recording import Recording

MANY = 1_000_000
NAMES = ("time", "current", "arm_angle")
in_any_folder = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def by_index(delimiter: str, places: list[int], decimal: str = ".") -> dict[str, Any]:
    columns = {name: {"index": i, "unit": u} for name, i, u in zip(NAMES, places, ("s", "A", "rad"), strict=True)}
    return {"delimiter": delimiter, "decimal": decimal, **columns}


@st.composite
def foreign_tables(draw: st.DrawFn) -> tuple[dict[str, Any], np.ndarray, list[list[str]]]:
    """Draw a map, the numbers of its three columns, and the cells of every row, of which others hold text or numbers."""
    delimiter = draw(st.sampled_from([" ", "\t", ",", ";", "|"]))
    decimal = "." if delimiter == "," else draw(st.sampled_from([".", ","]))
    width = draw(st.integers(3, 7))
    places = draw(st.permutations(range(width)))[:3]
    rows = draw(st.integers(3, 8))
    pairs = draw(arrays(np.int64, (rows, 2), elements=st.integers(-99, 99)))
    numbers = np.column_stack([np.arange(rows) / 8, pairs])
    others = st.sampled_from(["7", "note", f'"a{delimiter}b"', '""', f'"{delimiter}"'])
    cells = [[draw(others) for _ in range(width)] for _ in range(rows)]
    for row, values in zip(cells, numbers.tolist(), strict=True):
        for place, value in zip(places, values, strict=True):
            row[place] = repr(value).replace(".", decimal)
    return by_index(delimiter, list(places), decimal), numbers, cells


def written(cells: list[list[str]], table: dict[str, Any]) -> str:
    return "".join(table["delimiter"].join(row) + "\n" for row in cells)


@in_any_folder
@given(foreign_tables())
def test_each_column_is_read_from_its_own_cells(tmp_path: Path, drawn: Any) -> None:
    table, numbers, cells = drawn
    recording = Recording.read(save(tmp_path, written(cells, table)), table)
    assert np.array_equal(np.column_stack([recording.time, recording.command, recording.signals["arm_angle"]]), numbers)


@in_any_folder
@given(foreign_tables(), st.data())
def test_a_row_with_other_cells_than_the_rest_is_named(tmp_path: Path, drawn: Any, data: st.DataObject) -> None:
    table, _, cells = drawn
    row = data.draw(st.integers(0, len(cells) - 1))
    width = len(cells[0])
    if data.draw(st.booleans()):
        cells[row].insert(data.draw(st.integers(0, width)), "99")
    else:
        del cells[row][data.draw(st.integers(0, width - 1))]
    message = refusal(save(tmp_path, written(cells, table)), columns=table)
    assert f"row {row + 1}: has {len(cells[row])} cells where {width} are expected" in message


def test_a_header_of_other_cells_than_the_rows_is_refused(tmp_path: Path) -> None:
    names = {"time": {"column": "t", "unit": "s"}, "current": {"column": "i", "unit": "A"}}
    table = {"delimiter": " ", **names, "arm_angle": {"column": "phi", "unit": "rad"}}
    for header in ("t i [A] phi", "i t phi x", "t phi i x"):
        message = refusal(save(tmp_path, f"{header}\n0 1 2\n1 1 2\n2 1 2\n"), columns=table)
        assert "row 1: the header has 4 names, the rows have 3 cells" in message
        assert "index" in message
    assert "the header has 3 names, the rows have 4 cells" in refusal(
        save(tmp_path, "t i phi\n1 0 1 2\n2 1 1 2\n"), columns=table
    )
    assert "4 names" in refusal(save(tmp_path, "t,i,x,phi\n0,1,2\n1,1,2\n"), columns={**table, "delimiter": ","})
    for text in ("t,i,phi,,\n0,1,2\n1,1,2\n", "t,i,phi\n0,1,2,\n1,1,2,\n"):  # delimiters at the end move no column
        assert Recording.read(save(tmp_path, text), {**table, "delimiter": ","}).signals["arm_angle"].tolist() == [2, 2]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("mark", ['"', ""])
def test_numbers_of_rows_without_a_name_shift_no_column(tmp_path: Path, delimiter: str, mark: str) -> None:
    """R writes them before each row, and no name for them."""
    names = {"time": {"column": "t", "unit": "ms"}, "current": {"column": "i", "unit": "A"}}
    table = {"delimiter": delimiter, **names, "arm_angle": {"column": "phi", "unit": "rad"}}
    rows = "".join(f"{mark}{k}{mark},{5 * (k - 1)},{1 + k / 10},{k / 10}\n" for k in range(1, 5))
    message = refusal(save(tmp_path, f"t,i,phi\n{rows}".replace(",", delimiter)), columns=table)
    assert "row 1: the header has 3 names, the rows have 4 cells; does the first column lack a name?" in message
    by_number = table | {name: {"index": place, "unit": table[name]["unit"]} for place, name in enumerate(list(table)[1:], 1)}
    run = Recording.read(save(tmp_path, f"t,i,phi\n{rows}".replace(",", delimiter)), by_number)
    assert run.command.tolist() == [1.1, 1.2, 1.3, 1.4]


@pytest.mark.parametrize("skip", [4, 5, 5000, 10**30])
def test_more_rows_to_skip_than_a_file_has(tmp_path: Path, skip: int) -> None:
    table = {**by_index(",", [0, 1, 2]), "skip_rows": skip}
    message = refusal(save(tmp_path, "0,1,2\n1,1,2\n2,1,2\n3,1,2\n"), columns=table)
    assert f"skip_rows is {skip}, but the file has 4 lines" in message


@pytest.mark.parametrize("junk", ["\u00a0", "\x0b", "\x0c", "\x1c", "\x1d", "\x1e", "\x85", "\u2028", "\u3000", "\ufeff", "."])
def test_a_row_of_one_odd_character_is_not_dropped(tmp_path: Path, junk: str) -> None:
    assert "row 3: has 1 cells where 3 are expected" in refusal(save(tmp_path, GOOD.replace("0.1,2", f"{junk}\n0.1,2")))
    assert "row" in refusal(save(tmp_path, f"0 1 2\n1 1 2\n{junk}\n2 1 2\n"), columns=by_index(" ", [0, 1, 2]))
    if junk != "\ufeff":  # which may begin any file
        refusal(save(tmp_path, f"{junk}\n{GOOD}"))


def test_a_row_of_tabs_is_empty_cells_where_tabs_part_them(tmp_path: Path) -> None:
    assert "row 2, column 'time': is empty" in refusal(
        save(tmp_path, "0\t1\t2\n\t\t\n2\t1\t2\n"), columns=by_index("\t", [0, 1, 2])
    )
    assert len(Recording.read(save(tmp_path, GOOD + "\t\t\n  \n"))) == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{HEADER}\n" + "1,0.5\n0.1,2,0.6\n0.2,3,0.7\n", "row 2: has 2 cells where 3 are expected; is the row cut off?"),
        (
            GOOD.replace("0.1,2", "# pause\n0.1,2"),
            "row 3: has 1 cells where 3 are expected; a remark stands before",
        ),
        (GOOD.replace("0.1,2,0.6\n", "0.1,2,0.60.2"), "row 3: has 5 cells"),
        (GOOD.replace("0.6", "N/A"), "'N/A' is not a number; correct it, or leave the cell empty if nothing was measured"),
        (GOOD.replace("0.6", '"2,000"'), "'2,000' has a comma, which may mark thousands or decimals; export"),
        (GOOD.replace("0.6", '"-1,234,567"'), "'-1,234,567' has a comma, which may"),
        (GOOD.replace("0.6", '"0,600"'), "'0,600' has a decimal comma; say decimal = ','"),
        (GOOD.replace("1,0.5", ",0.5"), "row 2, column 'current': is empty, and the first command stands in row 3"),
    ],
)
def test_what_to_do_is_no_advice_that_spoils(tmp_path: Path, text: str, words: str) -> None:
    assert words in refusal(save(tmp_path, text))


def test_remarks_after_the_last_row_count_as_those_before_the_header(tmp_path: Path) -> None:
    whole = Recording.read(save(tmp_path, GOOD))
    for end in ("# end of log\n", "# end\n\n# stopped by hand", " # end of log\n\n"):
        recording = Recording.read(save(tmp_path, GOOD + end))
        assert np.array_equal(recording.signals["arm_angle"], whole.signals["arm_angle"])
        assert recording.conditions == {}
    assert Recording.read(save(tmp_path, GOOD + "# payload = 0.3 kg\n")).conditions == {"payload": 0.3}
    assert "row 5: " in refusal(save(tmp_path, GOOD + "# payload 0.3 kg\n"))
    assert "has no samples" in refusal(save(tmp_path, f"{HEADER}\n# end of log\n"))


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " "])
@pytest.mark.parametrize("cell", ["#N/A", "#DIV/0!", "########"])
def test_a_last_row_with_an_error_of_a_spreadsheet_is_no_remark(tmp_path: Path, delimiter: str, cell: str) -> None:
    rows = [["0", "1", "0.5"], ["0.1", "2", "0.6"], [cell, "3", "0.7"]]
    table = {"delimiter": delimiter, **by_index(delimiter, [0, 1, 2])}
    for last in (rows[2], [cell, "#N/A", "#N/A"]):
        message = refusal(save(tmp_path, written([*rows[:2], last], table)), columns=table)
        assert message.startswith(f"row 3, column 'time': '{cell}' is not a number")


@pytest.mark.parametrize(
    ("delimiter", "remark"),
    [(",", "# stopped by hand,,"), (" ", "# stopped by"), (" ", "# stopped by hand"), (" ", "# kp = 3")],
)
def test_a_remark_of_as_many_cells_is_none_of_the_rows(tmp_path: Path, delimiter: str, remark: str) -> None:
    table = by_index(delimiter, [0, 1, 2])
    recording = Recording.read(save(tmp_path, written([["0", "1", "2"], ["1", "1", "2"]], table) + remark + "\n"), table)
    assert len(recording) == 2


@pytest.mark.parametrize("mark", ["\u00a0", "\u2009", "\u202f", "\x1f", "\x0b"])
def test_a_mark_of_thousands_parts_no_cells(tmp_path: Path, mark: str) -> None:
    for rows in ("0 1{}000 2\n1 1{}001 2\n", "0 1{}000\n1 1{}001\n"):
        message = refusal(save(tmp_path, rows.replace("{}", mark)), columns=by_index(" ", [0, 1, 2]))
        assert "is not a number" in message or "the rows have 2 cells" in message


def test_a_line_of_millions_of_cells_is_refused_at_once(tmp_path: Path) -> None:
    with ends():
        assert "the limit is 100000 cells" in refusal(save(tmp_path, "," * 20_000_000))
        path = save(tmp_path, "0" + ",0" * 200_000 + "\n1" + ",1" * 200_000)
        assert "the limit is 100000 cells" in refusal(path, columns=by_index(",", [0, 1, 2]))


def test_a_first_row_cut_off_at_its_start_is_named(tmp_path: Path) -> None:
    message = refusal(save(tmp_path, "20\n1 2 11\n2 1 12\n"), columns=by_index(" ", [0, 1, 2]))
    assert "row 1: has 1 cells where 3 are expected; is the row cut off?" in message


LONG = [
    " ",
    "\t",
    "1",
    "a",
    "[",
    "]",
    "[ ",
    "] ",
    "#",
    "=",
    "= ",
    ":",
    "\u00a0",
    "_",
    ".",
    "1.",
    "e",
    "1e",
    "^",
    " *",
    "/ ",
    "kg ",
    "payload",
    "-",
    "µ",
    '"',
    "(",
]
LINES = [
    "# note = x{}y",
    "# payload = 1 k{}g",
    "# payload = 1{}",
    "# payload{}",
    "# a payload{}",
    "#{}",
    "# note [{}] = 1",
    "# note = 1 {}?",
    "time{}[s],current [A]",
]


def read_long(line: str, filler: str, work: Callable[[str], Any]) -> None:
    """Read a line of a million characters, which would take minutes at least in time that grows with their square."""
    with contextlib.suppress(InputError), ends():
        work(line.format(filler * (MANY // len(filler))))


@pytest.mark.parametrize("line", LINES)
def test_no_line_before_the_numbers_takes_longer_than_it_is(line: str) -> None:
    arm = Arm.load("thesis")
    for filler in LONG:
        read_long(line, filler, lambda text: read_upload(arm, "run.csv", f"{text}\n{GOOD}".encode(), None, []))


@pytest.mark.parametrize("text", ["{}", "1{}", "1 {}g", "1 k{}g", "1.{}kg", "1e{}", "-{}1", "1 kg{}", "1 kg {}m"])
def test_no_quantity_takes_longer_than_it_is(text: str) -> None:
    for filler in LONG:
        read_long(text, filler, units.is_quantity)
