"""Bad recordings: one line that names file, row and column, whatever the file holds."""

from __future__ import annotations

import gzip
import os
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from recording_files import GOOD, HEADER, refusal, save

from flexarm_env.errors import InputError
from flexarm_env.recordings.recording import Recording

# The first row before a clock was set, the others after.
LATE_CLOCK = "\n".join([HEADER, "0,1,2", *(f"{1.7e9 + 0.1 * k:.1f},1,2" for k in range(5)), ""])
# The text, and what the message must hold.
BAD = {
    "empty": ("", ["empty"]),
    "blank": ("\n\n", ["no header"]),
    "no header": ("0,1,2\n1,2,3\n", ["row 1", "header", "time [s]"]),
    "header only": (HEADER + "\n", ["no samples"]),
    "header only, no newline": (HEADER, ["no samples"]),
    "remarks only": ("# payload = 1 kg\n", ["no header"]),
    "one row": (HEADER + "\n0,1,2\n", ["1 sample", "two"]),
    "unknown unit": (GOOD.replace("[rad]", "[radd]"), ["arm_angle", "'radd'", "rad"]),
    "empty unit": (GOOD.replace("[rad]", "[]"), ["arm_angle", "no unit", "arm_angle [rad]"]),
    "wrong dimension": (GOOD.replace("[rad]", "[m]"), ["arm_angle", "'m'", "deg"]),
    "hertz is no rad/s": ("time [s],current [A],motor_speed [Hz]\n0,0,0\n1,0,0\n", ["'Hz'", "rpm"]),
    "percent is no angle": (GOOD.replace("[rad]", "[%]"), ["arm_angle", "'%'"]),
    "a unit that is a bomb": (GOOD.replace("[A]", "[A**9**9**9**9]"), ["current", "unknown unit"]),
    "no bracket": (GOOD.replace(" [rad]", ""), ["column 3", "arm_angle [rad]"]),
    "parentheses": (GOOD.replace("[rad]", "(rad)"), ["column 3", "arm_angle [rad]"]),
    "unknown column": (GOOD.replace("arm_angle", "arm_angel"), ["column 3", "did you mean 'arm_angle'"]),
    "extra column": (GOOD.replace("[rad]", "[rad],force [N]", 1), ["column 4", "'force'", "time"]),
    "nameless column": (GOOD.replace("[rad]", "[rad],", 1), ["column 4", "''"]),
    "no time": ("current [A],arm_angle [rad]\n0,1\n1,2\n", ["no time", "time [s]"]),
    "no input": ("time [s],arm_angle [rad]\n0,1\n1,2\n", ["neither", "current", "voltage"]),
    "both inputs": ("time [s],current [A],voltage [V],arm_angle [rad]\n0,1,1,1\n", ["both", "keep"]),
    "no signal": (
        "time [s],current [A],reference [rad]\n0,1,1\n1,2,2\n",
        ["no measured signal", "strain_mid"],
    ),
    "twice": (GOOD.replace("current [A]", "time [ms]"), ["column 2", "'time' comes twice"]),
    "text": (GOOD.replace("0.6", "oops"), ["row 3", "'arm_angle'", "'oops'"]),
    "text after blank lines": (GOOD.replace("0.1,2,0.6", "\n\n0.1,2,oops"), ["row 5", "'arm_angle'"]),
    "python number": (GOOD.replace("0.6", "1_0"), ["row 3", "'1_0'"]),
    "digits of elsewhere": (GOOD.replace("0.6", "٣"), ["row 3", "'arm_angle'"]),
    "decimal comma, quoted": (GOOD.replace("0.6", '"0,6"'), ["row 3", "'0,6'", "decimal comma", "decimal = ','"]),
    "decimal commas": (f"{HEADER}\n0,0,1,0,0,5\n", ["row 2", "6 cells", "'0,0,1,0,0,5'", "Export with decimal points"]),
    "semicolons": (GOOD.replace(",", ";"), ["semicolons", "delimiter = ';'"]),
    "tabs": (GOOD.replace(",", "\t"), ["tabs", "delimiter"]),
    "empty time": (GOOD.replace("0.1,2", ",2"), ["row 3", "'time'", "empty"]),
    "command too late": (GOOD.replace("1,0.5", ",0.5"), ["row 2", "'current'", "empty", "first command stands in row 3"]),
    "no command": (f"{HEADER}\n0,,1\n1,,2\n", ["row 2", "column 'current'", "no command in any row"]),
    "no reading at all": (f"{HEADER}\n0,1,\n1,1,nan\n", ["column 'arm_angle'", "no reading in any row"]),
    "empty reference": (
        GOOD.replace("[rad]\n", "[rad],reference [rad]\n").replace("0.6", "0.6,").replace("0.5", "0.5,1").replace("0.7", "0.7,1"),
        ["row 3", "'reference'", "empty"],
    ),
    "infinite": (GOOD.replace("0.6", "-inf"), ["row 3", "'arm_angle'", "inf"]),
    "too large": (GOOD.replace("0.6", "1e999"), ["row 3", "'arm_angle'", "inf"]),
    "too large once converted": (
        GOOD.replace("0.6", "1e308").replace("[rad]", "[turn]"),
        ["row 3", "'arm_angle'"],
    ),
    "nan time first": (GOOD.replace("\n0,", "\nnan,"), ["row 2", "'time'"]),
    "time goes back": (GOOD.replace("0.2,3", "0.05,3"), ["row 4", "'time'", "goes back"]),
    "time repeats": (GOOD.replace("0.2,3", "0.1,3"), ["row 4", "'time'", "repeats"]),
    "short row": (GOOD.replace("0.1,2,0.6", "0.1,2"), ["row 3", "2 cells"]),
    "long row": (GOOD.replace("0.1,2,0.6", "0.1,2,0.6,9"), ["row 3", "4 cells"]),
    "cut off": (GOOD[:-5], ["row 4"]),
    "remark among the numbers": (GOOD.replace("0.1,2,0.6", "# half way\n0.1,2,0.6"), ["row 3"]),
    "binary": (b"\x00\x01\x02" + GOOD.encode(), ["binary", "CSV"]),
    "latin-1": ((GOOD.replace("0.6", "0.6°")).encode("latin-1"), ["row 3", "UTF-8"]),
    "utf-16": (GOOD.encode("utf-16"), ["UTF-8"]),
    "gzip": (gzip.compress(GOOD.encode(), mtime=0), ["UTF-8"]),
    "zip": (b"PK\x03\x04\xff\xfe\xfd", ["UTF-8"]),
    "condition, bad unit": ("# payload = 0.3 kgg\n" + GOOD, ["row 1", "'kgg'"]),
    "condition, wrong unit": ("# payload = 0.3 m\n" + GOOD, ["row 1", "kg"]),
    "condition, comma": ("# payload = 0,3 kg\n" + GOOD, ["row 1", "0.3 kg"]),
    "condition, twice": ("# payload = 1 kg\n# payload = 2 kg\n" + GOOD, ["row 2", "twice"]),
    "condition, misspelt": ("# paylod = 1 kg\n" + GOOD, ["row 1", "did you mean 'payload'"]),
    "condition, negative": ("# payload = -1 kg\n" + GOOD, ["payload", "-1"]),
    "a clock set after the first row": (LATE_CLOCK, ["row 3", "apart"]),
    "no arm reads that": (GOOD.replace("0.6", "3e8"), ["row 3", "'arm_angle'", "unit"]),
    "time in the wrong unit": (f"{HEADER}\n0,1,2\n5e-12,1,2\n1e-11,1,2\n", ["'time'", "5e-12 s apart", "unit"]),
    "quote that closes in another row": (GOOD.replace("0.1,2,0.6", '0.1,"2,0.6').replace("0.2,3,", '0.2,3",'), ["row 3"]),
    "condition, after a colon": ("# payload: 0.3 m\n" + GOOD, ["row 1", "kg"]),
    "one endless field": ('"' + "x" * 200_000, ["CSV"]),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_one_clear_line(tmp_path: Path, case: str) -> None:
    text, wanted = BAD[case]
    message = refusal(save(tmp_path, text))
    for word in wanted:
        assert word in message


def test_absent_file(tmp_path: Path) -> None:
    assert "No such file" in refusal(tmp_path / "none.csv")


def test_folder_instead_of_file(tmp_path: Path) -> None:
    assert "is a folder" in refusal(tmp_path)


def test_a_folder_that_is_named_as_a_recording(tmp_path: Path) -> None:
    (tmp_path / "x.csv").mkdir()
    assert "is a folder" in refusal(tmp_path / "x.csv")
    save(tmp_path, GOOD)
    assert [one.name for one in Recording.read_all(tmp_path)] == ["run"]


def test_symlink_loop(tmp_path: Path) -> None:
    (tmp_path / "a.csv").symlink_to(tmp_path / "b.csv")
    (tmp_path / "b.csv").symlink_to(tmp_path / "a.csv")
    assert "cannot be read" in refusal(tmp_path / "a.csv")
    with pytest.raises(InputError, match="cannot be read"):
        Recording.read_all(tmp_path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    assert "not a regular file" in refusal(tmp_path / "pipe.csv")


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="permissions do not bind this user")
def test_permission_error(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD)
    path.chmod(0)
    assert "Permission denied" in refusal(path)


def test_impossible_path() -> None:
    with pytest.raises(InputError, match="cannot be read"):
        Recording.read("a\0b.csv")


def test_too_large_a_file_is_not_read(tmp_path: Path) -> None:
    path = tmp_path / "big.csv"
    with path.open("wb") as file:
        file.truncate(2 * 2**30)
    tracemalloc.start()
    message = refusal(path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 2**20
    assert "2048 MB" in message
    assert "256 MB" in message


def test_a_file_of_the_largest_size_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = save(tmp_path, GOOD)
    monkeypatch.setattr("flexarm_env.recordings.files.LARGEST_FILE", len(GOOD))
    assert len(Recording.read(path)) == 3
    monkeypatch.setattr("flexarm_env.recordings.files.LARGEST_FILE", len(GOOD) - 1)
    assert "the limit is" in refusal(path)


def test_control_characters_do_not_break_the_line(tmp_path: Path) -> None:
    path = save(tmp_path, GOOD.replace("0.6", '"a\x1bb\u2028c"'), "a\nb.csv")
    with pytest.raises(InputError) as caught:
        Recording.read(path)
    assert str(caught.value).isprintable()


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(where=st.integers(0, len(GOOD)), cut=st.integers(0, 20), junk=st.text(max_size=8) | st.binary(max_size=8))
def test_damaged_files_are_read_or_refused(tmp_path: Path, where: int, cut: int, junk: str | bytes) -> None:
    extra = junk if isinstance(junk, bytes) else junk.encode("utf-8", "surrogatepass")
    content = GOOD.encode()
    path = save(tmp_path, content[:where] + extra + content[where + cut :])
    message = ""
    try:
        assert np.all(np.diff(Recording.read(path).time) > 0)
    except InputError as error:
        message = str(error)
    assert not message or (message.startswith(str(path)) and message.isprintable())
