"""Command line: `wheelrail` or `python -m wheelrail` with `simulate`, `steady`, `train|sweep|ssp SCENARIO`, `patch WHEEL RAIL`,
`report|export RUN`, `schema KIND`, `completion SHELL`; what results say: see `analysis`."""

import json
import logging
import math
import os
import sys
import time
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout, suppress
from pathlib import Path

from . import __version__, analysis, completion, damage, page, paraview, patch_table, run_commands
from . import scenario as scenarios
from .compare import Died
from .controllers import ControllerFailed
from .files import BadFile, json_schema
from .fmu import Fmu, Refused, default_path, fmu_of_wheel
from .interrupt import told_to_end
from .output import fresh, results_folder, spare
from .sweep_command import SweepStopped
from .sweep_command import run as sweep
from .train import TrackEnds
from .warn import WheelrailWarning, in_lines
from .wheelset import patches_of


# Commands that need no scenario, and what runs them.
WITHOUT = dict.fromkeys(analysis.COMMANDS, analysis.run) | {
    "simulate": run_commands.run, "steady": run_commands.run, "report": page.command, "damage": damage.run, "export": paraview.run,
    "patch": patch_table.run,
    "schema": lambda options: print(json.dumps(json_schema(scenarios.SCHEMAS[options.kind]), indent=2)),
    "completion": lambda options: print(completion.script(parser(), options.shell), end=""),
}  # fmt: skip
LEVELS = ("debug", "info", "warning")
# What the earlier program in Rust took under the same name, and what does so now: commands, and options of commands.
BODIES = "{} is not about the patch of a record: fields in the whole bodies are written by cargo run --release --example fields in a checkout"
PLACES = {
    "--resources": "--resources is no option any more: presets are those of the FMU; wheelrail-pack pack --resources DIR makes one of others for --fmu",
    "--cache": "--cache is no option any more: the variable WHEELRAIL_CACHE names the folder in which computed bases are kept",
}
PACKER = "{0} is a command of wheelrail-pack, which cargo build --release makes in a checkout: target/release/wheelrail-pack {0}"
MOVED = {name: PACKER.format(name) for name in ("pack", "describe")} | {
    "export": dict.fromkeys(("--scenario", "--creepage", "--velocity", "--every", "--stop", "--preset", "--set"), BODIES),
    "simulate": PLACES,
    "steady": PLACES,
}


def called():
    """The name by which the command line was started."""
    name = Path(sys.argv[0]).stem
    return name if name in ("wheelrail", "wheelrail-train") else "python -m wheelrail"


def parser():
    """What the command line takes."""
    made = completion.Parser(prog=called(), description="A wheel rolls, a train brakes; what results say.")
    made.add_argument("--version", action="version", version=f"wheelrail {__version__}")
    commands = made.add_subparsers(dest="command", required=True)
    for name, about in (("train", "one stop dry, with and without slide protection"), ("sweep", "many stops")):
        add_stop(commands.add_parser(name, help=about))
    sweep = commands.choices["sweep"]
    sweep.add_argument("--scheduler", help="address of a dask scheduler; default: workers on this machine")
    sweep.add_argument("--workers", type=int, default=2, help="on this machine, default %(default)s")
    sweep.add_argument("--limit", type=float, default=1800.0, help="wall time of one stop [s], 0: none; default %(default)g")
    ssp = commands.add_parser("ssp", help="system packages (SSP, OSP) of a coach and its wheels")
    ssp.add_argument("scenario", type=Path, help="as of train")
    ssp.add_argument("--out", type=Path, default=Path("target"), help="directory, default %(default)s")
    ssp.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")
    ssp.add_argument("--coach", type=Path, default=Path("target/release"), help="where the coach was built, default %(default)s")
    ssp.add_argument("--step", type=float, default=1e-3, help="communication step [s], default %(default)g")
    ssp.add_argument("--stop", type=float, default=10.0, help="end of the default experiment [s], default %(default)g")
    schema = commands.add_parser("schema", help="JSON Schema of a kind of file")
    schema.add_argument("kind", choices=list(scenarios.SCHEMAS))
    for others in (run_commands, analysis, page, damage, paraview, patch_table, completion):
        others.add_command(commands)
    for command in commands.choices.values():
        command.add_argument("--version", action="version", version=f"wheelrail {__version__}")
        command.add_argument("--log", choices=LEVELS, help="say on the error stream what is done, from this level on")
    return made


def add_stop(command):
    """Arguments of `train` and `sweep`."""
    command.add_argument("scenario", type=Path, help="JSON file, see `python -m wheelrail schema scenario`")
    command.add_argument("--out", type=Path, default=Path("results"), help="results go to OUT/SCENARIO, default %(default)s")
    command.add_argument("--force", action="store_true", help="overwrite results that are there")
    wheels = command.add_mutually_exclusive_group()
    wheels.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")
    wheels.add_argument("--rigid", action="store_true", help="rigid wheelsets with a creep law, no FMU")
    command.add_argument("--step", type=float, help="communication step [s] in place of the scenario's")


def arguments(argv=None):
    """Command line. What another program does now is refused by name."""
    made, given = parser(), sys.argv[1:] if argv is None else argv
    made.wanted = next(iter(given), "")
    moved = MOVED.get(made.wanted, {})
    if isinstance(moved, str):
        made.error(moved)
    for option in (word.partition("=")[0] for word in given):
        if option in moved:
            made.error(moved[option].format(option))
    return made.parse_args(argv)


def train(options, scenario):
    """Three stops side by side: table, CSV, plot. What has come to its end is kept, whatever becomes of the others."""
    from . import compare, report
    from .plots import draw_stops
    from .progress import Progress

    out = results_folder(options.out, scenario.paths["scenario"].stem)
    path_of = {name: out / f"train_{name.lower().replace(' ', '_')}.csv" for name in compare.variants(scenario)}
    listed = [*path_of.values(), out / "train.png", out / "train.html", out / "train_columns.csv"]
    spare(listed, options.force)
    began, done, endless = time.perf_counter(), {}, {}
    with Progress(300, "braking") as bar:

        def progress(name, share):
            bar.advance(share - done.get(name, 0), ", ".join(f"{n} {s} %" for n, s in (done | {name: share}).items()))
            done[name] = share

        stops = compare.side_by_side(scenario, None if options.rigid else options.fmu, progress, endless)
    if stops:
        written = [out / "train_columns.csv", out / "train.png", *(path_of[name] for name in stops)]
        written += [out / "train.html"] if page.drawable() else []
        with ExitStack() as together:  # nothing takes the place of old results before all is written
            new = {path: together.enter_context(fresh(path)) for path in written}
            report.write_columns(new[written[0]], report.described(next(iter(stops.values()))[0]))
            draw_stops(new[written[1]], stops, scenario.name)
            for name, (table, _) in stops.items():
                report.write_csv(new[path_of[name]], table)
            page.of_train(new.get(out / "train.html"), stops, scenario)
        for old in set(listed) - set(written):
            old.unlink(missing_ok=True)
        # Last, since who reads it may have gone.
        print(f"\n{scenario.name}: {scenario.vehicle.name}, {scenario.brake.name}, {scenario.track.name}")
        print(f"wheelsets: {wheels(options, scenario)}\n")
        print("\n".join(report.lines({name: report.figures(table) for name, (table, _) in stops.items()})))
        simulated, wall = sum(table[-1, 0] for table, _ in stops.values()), time.perf_counter() - began
        print(f"\n{simulated:.0f} s simulated in {wall:.0f} s; written to {out}: {', '.join(path.name for path in written)}")
    if endless:
        raise TrackEnds("; ".join(f"{name}: {endless[name]}" for name in path_of if name in endless))


def wheels(options, scenario):
    """Words on what rolls."""
    if options.rigid:
        return "rigid, with a creep law"
    if scenarios.of_two_kinds(scenario):
        differs = ", ".join(f"{name} = {value}" for name, value in scenario.right_wheel.items()) or "is equal"
        return f"two wheels with patches of their own; the right one: {differs}, friction of its rail {scenario.right_friction:g} times the left one's"
    with Fmu(options.fmu) as fmu:
        return patches_of(fmu, scenario.vehicle.wheelset, scenario.wheel, scenario.temperatures)


def packages(options, scenario):
    """Writes coach.fmu and the packages."""
    from . import ssp

    for name, value in (("--step", options.step), ("--stop", options.stop)):
        if not (value > 0.0 and math.isfinite(value)):
            raise BadFile(f"{name} = {value:g} s is no time above zero")
    coach = results_folder(options.out, "") / "coach.fmu"
    texts = [path for path in map(Path, ("LICENSE-MIT", "LICENSE-APACHE", "docs/LICENSE-THIRD-PARTY")) if path.is_file()]
    with Fmu(options.fmu) as wheel:
        version = wheel.description.fmiVersion[0]
        ssp.pack_coach(options.coach / "coach", options.coach / "libcoach.so", coach, texts, version)
        with Fmu(coach) as opened:
            written = ssp.write(scenario, wheel, opened, (options.fmu, coach), options.out, options.stop, options.step)
    print("written:", ", ".join(str(path) for path in (coach, *written) if path))


def rigid(scenario):
    """Says what rigid wheelsets leave out of the parameters of the wheels. Names are those of the FMU, if there is one."""
    from .wheelset import LAW, FrictionLaw, runs_straight

    if default_path().is_file():
        opened(default_path(), scenario)
    FrictionLaw.of(scenario.wheel | scenario.sweep.wheel)
    runs_straight(scenario.wheel | scenario.sweep.wheel)
    ignored = [name for name in scenario.wheel | scenario.sweep.wheel if name not in LAW]
    ignored += ["temperatures"] if scenario.temperatures else []
    if ignored:
        print(f"rigid wheelsets know {' and '.join(LAW)} only; without effect: {', '.join(ignored)}", file=sys.stderr)


def opened(path, scenario):
    """Refuses, before anything is computed, an FMU that is missing or another one, and wheel parameters that it does not know."""
    try:
        with fmu_of_wheel(path, ", with --fmu, or take --rigid") as known:
            scenarios.check_wheel(scenario, {name: v for name, v in known.variables.items() if v.causality == "parameter"})
    except Refused as error:
        raise BadFile(str(error)) from None


def checked(options, scenario):
    """Options that fit together and to the scenario."""
    if options.step is not None:
        wrong = scenarios.SCENARIO["step"].check(options.step)
        if wrong:
            raise BadFile(f"--step {wrong}")
        scenario.step = options.step
    if options.command == "sweep":
        if options.workers < 1:
            raise BadFile(f"--workers = {options.workers} is below 1")
        if not options.limit >= 0.0:
            raise BadFile(f"--limit = {options.limit:g} s is not 0 (no limit) or more")
    if options.rigid:
        rigid(scenario)
    else:
        opened(options.fmu, scenario)


def main(argv=None):
    """Runs a command. Errors become one line: wrong arguments and files end with 2, runs that fail with 1, Ctrl-C
    and other signals with 128 and their number. Programs with windows have no streams: nothing is printed then."""
    with ExitStack() as stack:
        for redirect, stream in ((redirect_stdout, sys.stdout), (redirect_stderr, sys.stderr)):
            if stream is None:
                stack.enter_context(redirect(stack.enter_context(open(os.devnull, "w"))))
        command(argv)


def command(argv):
    """Runs a command."""
    options = arguments(argv)
    if options.log:
        logging.basicConfig(level=options.log.upper(), format="%(levelname)s %(name)s: %(message)s", stream=sys.stderr)
    with ended_in_a_line():
        run(options)


@contextmanager
def ended_in_a_line():
    """Warnings are lines meanwhile, and what ends a command is one line and an exit code, as `main` has them."""
    try:
        with in_lines(), told_to_end():
            yield
        sys.stdout.flush()
    except BrokenPipeError:  # who read what is printed has gone, such as `head`
        drop_output()
        sys.exit(1)
    except (BadFile, FileNotFoundError) as error:
        end(error, 2)
    except (Refused, TimeoutError, ControllerFailed, TrackEnds, Died, SweepStopped, WheelrailWarning, OSError) as error:
        end(error, getattr(error, "code", 1))
    except KeyboardInterrupt as stop:
        end(str(stop) or "stopped", getattr(stop, "code", 130))


def drop_output():
    """Sends what is still to be printed nowhere: Python would try once more at its end, and end with 120."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def end(error, code):
    """Ends with one line, unless the terminal is gone."""
    with suppress(OSError):
        print(f"error: {' '.join(str(error).split())}", file=sys.stderr)
    try:
        sys.stdout.flush()
    except OSError:
        drop_output()
    sys.exit(code)


def run(options):
    """Runs a command, most of which need no scenario."""
    if options.command in WITHOUT:
        WITHOUT[options.command](options)
        return
    scenario = scenarios.load(options.scenario)
    if options.command == "ssp":
        packages(options, scenario)
        return
    checked(options, scenario)
    (train if options.command == "train" else sweep)(options, scenario)


if __name__ == "__main__":
    main()
