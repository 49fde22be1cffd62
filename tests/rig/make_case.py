"""`python -m tests.rig.make_case FOLDER --seed S --set backlash=0.06 ...`: make a case with something hidden."""

from __future__ import annotations

import argparse
import json

from .catalogue import CATALOGUE
from .recordings import write_case
from .settings import table


def setting(text: str) -> tuple[str, float]:
    """Read NAME=VALUE; NAME is a setting of the rig or an effect of the catalogue."""
    name, _, value = text.partition("=")
    return CATALOGUE.get(name, name), float(value)


def parser() -> argparse.ArgumentParser:
    """Return the command's options."""
    made = argparse.ArgumentParser(
        prog="python -m tests.rig.make_case",
        description="Write pulse.csv, square.csv and sweep.csv of an arm with hidden settings.",
        epilog="settings, with their null or standard value and unit:\n" + table().replace("%", "%%"),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("folder")
    made.add_argument("--seed", type=int, default=0)
    made.add_argument("--set", nargs="+", action="extend", type=setting, default=[], metavar="NAME=VALUE")
    made.add_argument("--as-practice", action="store_true", help="keep the practice runs' sizes and times")
    return made


def main(arguments: list[str] | None = None) -> None:
    """Write the case and print what it hides."""
    options = parser().parse_args(arguments)
    hidden = dict(options.set)
    try:
        paths = write_case(options.folder, hidden, options.seed, vary=not options.as_practice)
    except KeyError as error:
        raise SystemExit(str(error.args[0])) from None
    print(json.dumps({"settings": hidden, "seed": options.seed, "files": [str(p) for p in paths]}))


if __name__ == "__main__":
    main()
