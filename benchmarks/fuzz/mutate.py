"""Damage to the bytes of a file, as disks, transfers, editors and hostile people make it."""

from __future__ import annotations

import random
import re
from collections.abc import Callable

from benchmarks.fuzz.corpus import TURNS

MOST_CHANGES = 4
LONGEST = 200_000
#: Share of texts of which only numbers, words and lines are changed, so that most still have their form.
GENTLE_SHARE = 0.7
#: What breaks readers of text: numbers beyond all, marks of formats, characters that are no blank or are many bytes.
TOKENS = (
    *("nan", "inf", "-inf", "1e999", "-1e999", "1e-999", "0", "-0", "1_0", "0x10", "1,5", "1.5.5", "--", "1e", "9" * 30),
    *("true", "null", "{}", "[]", "()", "''", '""', "\t", "\n", "\r", "\0", "..", "**", *",; \"'#%=:[]{}()\\/.-_*^"),
    *("\u00a0", "\x0b", "\x0c", "\x1c", "\x85", "\u2028", "\ufeff", "µ", "°", "٣", "😀", "\ud800"),
    *("# payload = 1 kg\n", "# payload 1 kg\n", "# start = nan s\n", "# K1 = 1\n", "sep=|\n", "time [s]", "[columns]\n"),
    *("1e7 A", "-1 rad", "9**9**9**9 V", "__import__('os')", "effects", "drive", "beam", "cogging", "elements = 99\n"),
)
WORD = re.compile(rb"[A-Za-z_]\w*")
NUMBERS = (*b"0 2 17 0.5 -1 1e-9 1e5 1e7 1e9 1e300 -1e-300 5e-324 nan inf".split(), b"")
NUMBER = re.compile(rb"[-+]?\d+\.?\d*")


def mutate(content: bytes, draw: random.Random, others: bytes) -> bytes:
    """Damage a file's content once to MOST_CHANGES times.

    Args:
        content: of a sound file.
        draw: random numbers.
        others: content of another file, of which a part may come in.
    """
    changes = GENTLE if b"\0" not in content and draw.random() < GENTLE_SHARE else CHANGES
    for _ in range(draw.randint(1, draw.randint(1, MOST_CHANGES))):
        content = draw.choice(changes)(content, draw, others)[:LONGEST]
    return content


def _span(content: bytes, draw: random.Random) -> tuple[int, int]:
    first = draw.randrange(len(content) + 1)
    return first, min(len(content), first + draw.choice((1, 2, 4, 8, 40, 400)))


def _flip(content: bytes, draw: random.Random, others: bytes) -> bytes:
    if not content:
        return content
    changed = bytearray(content)
    for _ in range(draw.choice((1, 1, 1, 8))):
        changed[draw.randrange(len(changed))] ^= 1 << draw.randrange(8)
    return bytes(changed)


def _cut(content: bytes, draw: random.Random, others: bytes) -> bytes:
    first, last = _span(content, draw)
    return content[:first] + content[last:]


def _end(content: bytes, draw: random.Random, others: bytes) -> bytes:
    return content[: draw.randrange(len(content) + 1)]


def _repeat(content: bytes, draw: random.Random, others: bytes) -> bytes:
    first, last = _span(content, draw)
    return content[:last] + content[first:last] * draw.choice((1, 1, 2, 50, 5000)) + content[last:]


def _insert(content: bytes, draw: random.Random, others: bytes) -> bytes:
    first, _ = _span(content, draw)
    token = draw.choice(TOKENS).encode("utf-8", "surrogatepass")
    return content[:first] + token * draw.choice((1, 1, 1, 1, 3, 2000)) + content[first:]


def _noise(content: bytes, draw: random.Random, others: bytes) -> bytes:
    first, last = _span(content, draw)
    return content[:first] + draw.randbytes(last - first) + content[last:]


def _turn(content: bytes, draw: random.Random, others: bytes) -> bytes:
    first = draw.randrange(len(content) // 4 + 1) * 4
    number = draw.choice(TURNS)
    return content[:first] + (number if draw.random() < 0.7 else number[::-1]) + content[first + 4 :]


def _renumber(content: bytes, draw: random.Random, others: bytes) -> bytes:
    numbers = list(NUMBER.finditer(content))
    if not numbers:
        return content
    found = draw.choice(numbers)
    return content[: found.start()] + draw.choice(NUMBERS) + content[found.end() :]


def _splice(content: bytes, draw: random.Random, others: bytes) -> bytes:
    here, (first, last) = _span(content, draw)[0], _span(others, draw)
    return content[:here] + others[first:last] + content[here:]


def _reword(content: bytes, draw: random.Random, others: bytes) -> bytes:
    """Put another word of the same file, or of another one, in the place of a word."""
    words, new = list(WORD.finditer(content)), WORD.findall(content) + WORD.findall(others[:LONGEST])
    if not words:
        return content
    found = draw.choice(words)
    return content[: found.start()] + draw.choice(new) + content[found.end() :]


def _lines(content: bytes, draw: random.Random, others: bytes) -> bytes:
    """Exchange two lines, or leave out or repeat one."""
    lines = content.split(b"\n")
    one, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    lines[one], lines[other] = lines[other], lines[one]
    lines[one : one + 1] = [lines[one]] * draw.choice((0, 1, 1, 2))
    return b"\n".join(lines)


Change = Callable[[bytes, random.Random, bytes], bytes]
GENTLE: tuple[Change, ...] = (_renumber, _renumber, _renumber, _reword, _reword, _lines)
CHANGES: tuple[Change, ...] = (
    _flip,
    _cut,
    _end,
    _repeat,
    _insert,
    _noise,
    _turn,
    _renumber,
    _splice,
    _reword,
    _lines,
)
