"""The commands, and what each takes."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexarm_env.arm import Arm
    from flexarm_env.identify.recording import Recording

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode="rich",
    help="Find out where the model of a flexible arm is wrong, and add what it lacks.",
    epilog="Exit code 0: done. 1: done, and the answer is no. 2: bad input, with one line that says which.",
    context_settings={"help_option_names": ["-h", "--help"]},
)

Recordings = Annotated[
    list[Path], typer.Argument(metavar="RECORDING…", help="CSV files, or folders of them.", show_default=False)
]
ArmName = Annotated[str, typer.Option("--arm", metavar="ARM", help="Arm file, or a shipped arm: thesis, thesis-fem.")]
Columns = Annotated[
    Path | None,
    typer.Option(metavar="FILE.toml", help="How foreign recordings name their columns: a \\[columns] table."),
]
Effects = Annotated[
    list[str] | None,
    typer.Option(metavar="FILE.py:Name", help="An effect of your own, besides the catalogue; may be repeated. Runs FILE.py."),
]
Json = Annotated[Path | None, typer.Option("--json", metavar="FILE", help="Write the result as JSON; - for stdout.")]
Report = Annotated[Path | None, typer.Option(metavar="FILE.html", help="Write a page with figures.")]
Save = Annotated[Path | None, typer.Option(metavar="ARM.toml", help="Write the arm that results.")]
Seed = Annotated[int, typer.Option(min=0, help="Of everything random.")]


def _version(wanted: bool) -> None:
    if wanted:
        from flexarm_env import __version__

        print(f"flexarm {__version__}")
        raise typer.Exit


@app.callback()
def _all(
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")] = False,
) -> None:
    pass


@app.command()
def compare(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    report: Report = None,
    json: Json = None,
) -> None:
    """Replay recordings through an arm: error per signal, regime and frequency band, against the noise."""
    _check(json, report, read=_read(recordings, columns, arm), specs=effects, pictures=report is not None)
    model, runs = _load(recordings, arm, columns, effects)
    from flexarm_env.cli import outputs, tables, work

    result = work.compare(model, runs)
    work.finish("compare", arm, runs, None, json, work.comparison_json(result), tables.comparison(result))
    if report is not None:
        line = _command("compare", recordings, arm, columns, effects)
        work.report(report, runs, result, None, line | outputs.provenance("compare", arm, runs, None))


@app.command()
def diagnose(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    report: Report = None,
    save: Save = None,
    next_run: Annotated[
        Path | None, typer.Option(metavar="FILE.csv", help="Write the input to record next, where something stays open.")
    ] = None,
    seed: Seed = 0,
    jobs: Annotated[int, typer.Option(min=1, max=256, help="Processes to use.")] = 2,
    json: Json = None,
) -> None:
    """Tell whether constants are wrong or an effect is missing, which one, how sure, and what would settle it."""
    read = _read(recordings, columns, arm, save)
    _check(json, report, save, next_run, read=read, specs=effects, pictures=report is not None)
    model, runs = _load(recordings, arm, columns, effects)
    from flexarm_env.cli import outputs, tables, work
    from flexarm_env.files import write_whole

    result = work.diagnose(model, runs, seed, jobs)
    work.finish("diagnose", arm, runs, seed, json, result.as_json(), tables.diagnosis(result))
    _save(result.arm, save)
    if next_run is not None and result.next_run is not None:
        write_whole(next_run, result.next_run.as_csv())
    if report is not None:
        line = _command("diagnose", recordings, arm, columns, effects, seed)
        made = line | outputs.provenance("diagnose", arm, runs, seed)
        work.report(report, runs, work.compare(result.nominal, runs), result, made)
    if result.verdict in ("unknown", "insufficient_data"):
        raise typer.Exit(1)


@app.command()
def add(
    effect: Annotated[str, typer.Argument(metavar="EFFECT", help="Name in the catalogue, or FILE.py:Name of your own.")],
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    save: Save = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Add one effect to an arm and refit: error before, refitted, after. Exit code 1 if it does not fall."""
    own = [effect] if ".py:" in effect else []
    specs = [*(effects or []), *own]
    _check(json, save, read=_read(recordings, columns, arm, save), specs=specs)
    model, runs = _load(recordings, arm, columns, specs)
    from flexarm_env.cli import tables, work

    result = work.add(work.own_name(effect) if own else effect, model, runs, seed)
    work.finish("add", arm, runs, seed, json, work.addition_json(result), tables.addition(result))
    _save(result.arm, save, hint=True)
    if not result.error["final"] < result.error["refitted"]:
        raise typer.Exit(1)


@app.command()
def fit(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    save: Save = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Refit the constants of an arm, and add nothing."""
    _check(json, save, read=_read(recordings, columns, arm, save), specs=effects)
    model, runs = _load(recordings, arm, columns, effects)
    from flexarm_env.cli import tables, work

    result = work.fit(model, runs, seed)
    work.finish("fit", arm, runs, seed, json, work.fit_json(result), tables.fit(result))
    _save(result.arm, save, hint=True)


@app.command()
def simulate(
    save: Annotated[Path, typer.Option(metavar="FILE.csv", help="Write the recording.", show_default=False)],
    arm: ArmName = "thesis",
    input: Annotated[
        str, typer.Option(metavar="INPUT", help="pulse, square, sweep, or a file of commands to play: time and input.")
    ] = "pulse",
    duration: Annotated[float, typer.Option(help="Seconds; a recording brings its own.")] = 10.0,
    rate: Annotated[float, typer.Option(help="Samples per second; a recording brings its own.")] = 500.0,
    noise: Annotated[bool, typer.Option(help="Noise and steps of the sensors.")] = True,
    columns: Columns = None,
    effects: Effects = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Make a recording with an arm's model."""
    _check(json, save, read=_read([Path(input)] if input else [], columns, arm), specs=effects)
    from flexarm_env.cli import work

    model = _arm(arm, effects)
    work.simulate(model, arm, input, (duration, rate, seed, noise), columns, save, json)


@app.command()
def effects(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="An effect, or FILE.py:Name of your own.")] = None,
    json: Json = None,
) -> None:
    """Show the catalogue of effects, or one effect: equation, parameters, what it looks like in data."""
    _check(json)
    from flexarm_env.cli import catalogue

    catalogue.show(name, json)


@app.command()
def demo(
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where pictures, page and numbers go.")] = Path("results/demo"),
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Find the effect that is hidden in three recordings, add it, and draw how the error falls."""
    _check(json, pictures=True)
    from flexarm_env.demo.story import tell

    if not tell(output, seed, json):
        raise typer.Exit(1)


@app.command()
def thesis(
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where page, figures and numbers go.")] = Path("results/thesis"),
    json: Json = None,
) -> None:
    """Check the claims of the thesis that the model comes from, and draw its figures again."""
    _check(json, pictures=True)
    from flexarm_env.thesis.reproduce import reproduce

    reproduce(output, json)


@app.command()
def lab(
    recordings: Annotated[
        list[Path] | None, typer.Argument(metavar="[RECORDING…]", help="CSV files, or folders of them.", show_default=False)
    ] = None,
    arm: ArmName = "thesis-fem",
    columns: Columns = None,
    effects: Effects = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="To listen at on this machine; 0 takes any.")] = 8071,
    show: Annotated[bool, typer.Option("--show/--no-show", help="Open a browser.")] = True,
) -> None:
    """Do the same in a browser: drop recordings in, play with effects, diagnose, add. Serves this machine only."""
    from flexarm_env.cli import outputs

    outputs.need_lab()
    model, runs = _load(recordings, arm, columns, effects) if recordings else (_arm(arm, effects), [])
    from flexarm_env.lab.server import serve

    serve(model, runs, columns, port, show)


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def bench(context: typer.Context) -> None:
    """Measure speed and accuracy (in a source tree)."""
    from flexarm_env.cli import work

    raise typer.Exit(work.bench(context.args))


def _check(
    json: Path | None,
    *places: Path | None,
    read: Sequence[Path] = (),
    specs: Sequence[str] | None = None,
    pictures: bool = False,
) -> None:
    from flexarm_env.cli import outputs

    files = [Path(spec.rpartition(":")[0]) for spec in specs or () if ":" in spec]
    outputs.check_places(json, *places, read=[*read, *files])
    if pictures:
        outputs.need_plots()


def _read(recordings: Sequence[Path], columns: Path | None, arm: str, save: Path | None = None) -> list[Path]:
    """Return what a command reads and must not write; the arm's own file may be saved anew."""
    found = [*recordings, *([columns] if columns is not None else [])]
    return [*found, Path(arm)] if Path(arm).is_file() and save != Path(arm) else found


def _command(
    name: str,
    recordings: Sequence[Path],
    arm: str,
    columns: Path | None,
    specs: Sequence[str] | None,
    seed: int | None = None,
) -> dict[str, str]:
    """Return the command line that does this again, for the report."""
    import shlex

    words = ["flexarm", name, *map(str, recordings), "--arm", arm]
    words += ["--columns", str(columns)] if columns is not None else []
    words += [word for spec in specs or () for word in ("--effects", spec)]
    words += ["--seed", str(seed)] if seed is not None else []
    return {"command_line": shlex.join(words)}


def _arm(name: str, specs: Sequence[str] | None) -> Arm:
    from flexarm_env.arm import Arm
    from flexarm_env.cli import inputs

    return Arm.load(name, inputs.known_effects(specs or []))


def _load(paths: list[Path], name: str, columns: Path | None, specs: Sequence[str] | None) -> tuple[Arm, list[Recording]]:
    from flexarm_env.cli import inputs

    arm = _arm(name, specs)
    return arm, inputs.read_recordings(arm, paths, columns)


def _save(arm: Arm, path: Path | None, hint: bool = False) -> None:
    if path is not None:
        arm.save(path)
    elif hint:
        typer.echo("Not saved; --save ARM.toml keeps the arm.", err=True)
