"""The commands and their arguments."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from flexarm_env.cli import arguments
from flexarm_env.cli.options import ArmName, Columns, Effects, Json, Rate, Recordings, RecordingsOrNone, Report, Save, Seed, place

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode="rich",
    help="Find out where the model of a flexible arm is wrong, and add what it lacks.",
    epilog="Exit code 0: done. 1: done, and the answer is no. 2: bad input, with one line that says which.",
    context_settings={"help_option_names": ["-h", "--help"]},
)


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
def inspect(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    report: Report = None,
    json: Json = None,
) -> None:
    """Look at recordings first: signals, faults, and what they can show. Exit code 1 for a fault, or too little."""
    given = arguments.Given(recordings, arm, columns, effects)
    from flexarm_env.cli.answers import hand_out, inspect_restart
    from flexarm_env.recordings.clock import RestartError

    try:
        model, runs = given.load(json, report)
    except RestartError as error:
        inspect_restart(error, arguments.load_arm(arm, effects), arm, json, report, given.command_line("inspect"))
        raise typer.Exit(1) from None
    from flexarm_env.terminal import identification
    from flexarm_env.terminal.inspection_report import write_inspection
    from flexarm_env.terminal.inspection_tables import inspection
    from flexarm_env.terminal.provenance import provenance

    found = identification.inspect(model, runs)

    def write(path: Path) -> None:
        write_inspection(path, found, given.command_line("inspect") | provenance("inspect", arm, runs, None))

    hand_out("inspect", arm, runs, None, json, found.as_json(), inspection(found), [(report, write)])
    if not found.is_sound:
        raise typer.Exit(1)


@app.command()
def compare(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    rate: Rate = None,
    report: Report = None,
    json: Json = None,
) -> None:
    """Replay recordings through an arm: error per signal, regime and frequency band, against the noise."""
    given = arguments.Given(recordings, arm, columns, effects)
    model, runs = given.load(json, report)
    from flexarm_env.cli.answers import hand_out
    from flexarm_env.terminal import identification, plain_data, tables
    from flexarm_env.terminal.provenance import provenance

    result = identification.compare_and_inspect(model, runs, rate)

    def write(path: Path) -> None:
        made = given.command_line("compare", rate=rate) | provenance("compare", arm, runs, None)
        identification.write_page(path, runs, result, None, made)

    content = plain_data.of_comparison(result)
    hand_out("compare", arm, runs, None, json, content, tables.comparison(result), [(report, write)])


@app.command()
def diagnose(
    recordings: RecordingsOrNone = None,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    rate: Rate = None,
    report: Report = None,
    save: Save = None,
    next_run: Annotated[
        Path | None,
        typer.Option(parser=place, metavar="FILE.csv", help="Write the input to record next, where something stays open."),
    ] = None,
    seed: Seed = 0,
    jobs: Annotated[int, typer.Option(min=1, max=256, help="Processes to use.")] = 2,
    time_limit: Annotated[
        float | None,
        typer.Option(
            metavar="SECONDS", help="Try nothing more after that time; conclude from what is known.", show_default="none"
        ),
    ] = None,
    settings: Annotated[
        bool, typer.Option("--settings", help="Print the numbers of the method instead; needs no recordings.")
    ] = False,
    json: Json = None,
) -> None:
    """Find out whether constants are wrong or an effect is missing: which one, how sure, and the run to record next."""
    if settings:
        arguments.check(json, read=recordings or [])
        from flexarm_env.cli.settings import show

        show(json)
        return
    given = arguments.Given(arguments.required(recordings, "diagnose"), arm, columns, effects)
    from flexarm_env.cli.answers import diagnose_restart, findings, hand_out, note_missing
    from flexarm_env.recordings.clock import RestartError

    try:
        model, runs = given.load(json, report, save, next_run)
    except RestartError as error:
        result = diagnose_restart(error, arguments.load_arm(arm, effects), arm, seed, json, report)
        note_missing(result, save, next_run)
        raise typer.Exit(1) from None
    from flexarm_env.terminal import identification, tables
    from flexarm_env.terminal.provenance import provenance

    result = identification.diagnose(model, runs, seed, jobs, rate, time_limit)

    def write(path: Path) -> None:
        made = given.command_line("diagnose", seed, rate) | provenance("diagnose", arm, runs, seed)
        identification.write_page(path, runs, identification.compare(result.nominal, runs, rate), result, made)

    files = [*findings(result, save, next_run), (report, write)]
    hand_out("diagnose", arm, runs, seed, json, result.as_json(), tables.diagnosis(result), files)
    note_missing(result, save, next_run)
    if result.verdict in ("partly", "unknown", "insufficient_data", "recordings"):
        raise typer.Exit(1)


@app.command()
def add(
    effect: Annotated[str, typer.Argument(metavar="EFFECT", help="Name in the catalogue, or FILE.py:Name of your own.")],
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    rate: Rate = None,
    save: Save = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Add one effect to an arm and refit: error before, refitted, after. Exit code 1 if it does not fall."""
    from flexarm_env.effects.catalogue import is_of_file, load_effect

    own = [effect] if is_of_file(effect) else []
    model, runs = arguments.Given(recordings, arm, columns, [*(effects or []), *own]).load(json, save=save)
    from flexarm_env.cli.answers import hand_out
    from flexarm_env.terminal import identification, plain_data, tables

    arguments.show_faults(identification.faults(model, runs))
    result = identification.add(load_effect(effect).name if own else effect, model, runs, seed, rate)
    files = [(save, result.arm.save)]
    hand_out("add", arm, runs, seed, json, plain_data.of_addition(result), tables.addition(result), files)
    arguments.hint_at_save(save)
    if not result.error["final"] < result.error["refitted"]:
        raise typer.Exit(1)


@app.command()
def fit(
    recordings: Recordings,
    arm: ArmName = "thesis",
    columns: Columns = None,
    effects: Effects = None,
    rate: Rate = None,
    save: Save = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Refit the constants of an arm, and add nothing."""
    model, runs = arguments.Given(recordings, arm, columns, effects).load(json, save=save)
    from flexarm_env.cli.answers import hand_out
    from flexarm_env.terminal import identification, plain_data, tables

    arguments.show_faults(identification.faults(model, runs))
    result = identification.fit(model, runs, seed, rate)
    files = [(save, result.arm.save)]
    hand_out("fit", arm, runs, seed, json, plain_data.of_fit(result), tables.fit(result), files)
    arguments.hint_at_save(save)


@app.command()
def simulate(
    save: Annotated[Path, typer.Option(parser=place, metavar="FILE.csv", help="Write the recording.", show_default=False)],
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
    given = arguments.Given([Path(input)] if input else [], arm, columns, effects)
    arguments.check(json, read=given.files(), recording=save, specs=effects)
    from flexarm_env.cli import simulation

    model = arguments.load_arm(arm, effects)
    simulation.simulate(model, arm, input, (duration, rate, seed, noise), columns, save, json)


@app.command()
def effects(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="An effect, or FILE.py:Name of your own.")] = None,
    json: Json = None,
) -> None:
    """Show the catalogue of effects, or one effect: equation, parameters, what it looks like in data."""
    arguments.check(json)
    from flexarm_env.cli import catalogue

    catalogue.show(name, json)


@app.command()
def tune(
    controller: Annotated[
        str, typer.Argument(metavar="CONTROLLER", help="Name of a control law, such as lqg or pid_compensated.")
    ],
    arm: ArmName = "thesis",
    effects: Effects = None,
    start: Annotated[
        Path | None, typer.Option(metavar="FILE.toml", help="A tuned controller to start from, such as one for the nominal arm.")
    ] = None,
    save: Annotated[Path | None, typer.Option(parser=place, metavar="FILE.toml", help="Write the tuned controller.")] = None,
    trials: Annotated[int, typer.Option(min=1, help="Values to try.")] = 120,
    arms: Annotated[int, typer.Option(min=1, max=1000, help="Arms in each cell of a trial.")] = 12,
    journal: Annotated[
        Path | None,
        typer.Option(parser=place, metavar="FILE", help="Keep the trials there: after a stop the same command goes on."),
    ] = None,
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Search for the options of a controller on an arm, with robustness among the objectives, and measure its margins."""
    read = [*([start] if start else []), *arguments.arm_files(arm)]
    arguments.check(json, save, journal, read=read, specs=effects)
    from flexarm_env.cli import tuning
    from flexarm_env.tuning.search import Budget

    model = arguments.load_arm(arm, effects)
    tuning.run(controller, model, arm, Budget(trials, arms, seed), start, (save, journal, json))


@app.command()
def envs(arm: ArmName = "thesis", json: Json = None) -> None:
    """List the environments with an arm: task, observation, action, length of an episode."""
    arguments.check(json, read=arguments.arm_files(arm))
    from flexarm_env.cli import environments

    environments.show(arm, json)


@app.command()
def demo(
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where pictures, page and numbers go.")] = Path("results/demo"),
    seed: Seed = 0,
    json: Json = None,
) -> None:
    """Find the effect that is hidden in three recordings, add it, and draw how the error falls."""
    arguments.check(json, pictures=True)
    from flexarm_env.demo.story import run_demo

    if not run_demo(output, seed, json):
        raise typer.Exit(1)


@app.command()
def thesis(
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where page, figures and numbers go.")] = Path("results/thesis"),
    json: Json = None,
) -> None:
    """Check the claims of the thesis that the model comes from, and draw its figures again."""
    arguments.check(json, pictures=True)
    from flexarm_env.thesis.reproduce import reproduce

    reproduce(output, json)


@app.command()
def rigs(
    folder: Annotated[Path, typer.Argument(metavar="FOLDER", help="Published recordings of real rigs.", show_default=False)],
    output: Annotated[Path, typer.Option(metavar="FOLDER", help="Where answers, pictures and page go.")] = Path("results/rigs"),
    only: Annotated[list[str] | None, typer.Option(metavar="RIG", help="One of the rigs; may be repeated.")] = None,
    jobs: Annotated[int, typer.Option(min=1, max=256, help="Processes to use.")] = 2,
    json: Json = None,
) -> None:
    """Diagnose the real rigs in a folder, beside the published figures; goes on where it stopped. Exit code 1 below a goal."""
    arguments.check(json, pictures=True)
    from flexarm_env.rigs.command import make_gallery

    if not make_gallery(folder, output, only or [], jobs, json):
        raise typer.Exit(1)


@app.command()
def lab(
    recordings: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[RECORDING…]", help="Recordings (.csv, .mat, …), or folders.", show_default=False),
    ] = None,
    arm: ArmName = "thesis-fem",
    columns: Columns = None,
    effects: Effects = None,
    port: Annotated[int, typer.Option(min=0, max=65535, help="To listen at on this machine; 0 takes any.")] = 8071,
    show: Annotated[bool, typer.Option("--show/--no-show", help="Open a browser.")] = True,
) -> None:
    """Do the same in a browser: drop recordings in, play with effects, diagnose, add. Serves this machine only."""
    from flexarm_env.terminal import outputs

    outputs.need_lab()
    model, runs = arguments.Given(recordings or [], arm, columns, effects).read()
    from flexarm_env.lab.server import serve
    from flexarm_env.lab.session import Session

    serve(lambda: Session(model, columns, effects or (), arm), runs, port, show)


@app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def bench(context: typer.Context) -> None:
    """Measure speed and accuracy (in a source tree)."""
    from flexarm_env.cli import benchmarks

    raise typer.Exit(benchmarks.run(context.args))
