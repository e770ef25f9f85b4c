"""Command line: `python -m wheelrail train|sweep|ssp SCENARIO`, `report RUN`, `schema KIND`; what results say: see `analysis`."""

import argparse
import json
import sys
import time
from pathlib import Path

from . import analysis
from . import scenario as scenarios
from .files import BadFile, json_schema
from .fmu import Fmu, Refused, default_path
from .page import command as page


def arguments(argv=None):
    """Command line."""
    parser = argparse.ArgumentParser(prog="wheelrail", description="A train brakes; what results say.")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, about in (("train", "one stop dry, with and without slide protection"), ("sweep", "many stops")):
        command = commands.add_parser(name, help=about)
        command.add_argument("scenario", type=Path, help="JSON file, see `wheelrail schema scenario`")
        command.add_argument("--out", type=Path, default=Path("results"), help="directory, default %(default)s")
        wheels = command.add_mutually_exclusive_group()
        wheels.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")
        wheels.add_argument("--rigid", action="store_true", help="rigid wheelsets with a creep law, no FMU")
        command.add_argument("--step", type=float, help="communication step [s] in place of the scenario's")
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
    analysis.add_commands(commands)
    page.add_command(commands)
    return parser.parse_args(argv)


def train(options, scenario):
    """Three stops side by side: table, CSV, plot."""
    from tqdm import tqdm

    from . import compare, report
    from .plots import draw_stops

    began, done = time.perf_counter(), {}
    with tqdm(total=300, desc="braking", bar_format="{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]") as bar:

        def progress(name, share):
            done[name] = share
            bar.set_postfix_str(", ".join(f"{name} {share} %" for name, share in done.items()), refresh=False)
            bar.update(sum(done.values()) - bar.n)

        stops = compare.side_by_side(scenario, None if options.rigid else options.fmu, progress)
    print(f"\n{scenario.name}: {scenario.vehicle.name}, {scenario.brake.name}, {scenario.track.name}\n")
    print("\n".join(report.lines({name: report.figures(table) for name, (table, _) in stops.items()})))
    options.out.mkdir(parents=True, exist_ok=True)
    written = []
    for name, (table, _) in stops.items():
        written.append(options.out / f"train_{name.lower().replace(' ', '_')}.csv")
        report.write_csv(written[-1], table)
    written.append(options.out / "train.png")
    draw_stops(written[-1], stops)
    written += page.of_train(options.out / "train.html", stops, scenario)
    simulated = sum(table[-1, 0] for table, _ in stops.values())
    wall = time.perf_counter() - began
    print(f"\n{simulated:.0f} s simulated in {wall:.0f} s; written: {', '.join(map(str, written))}")


def packages(options, scenario):
    """Writes coach.fmu and the packages."""
    from . import ssp

    options.out.mkdir(parents=True, exist_ok=True)
    coach = options.out / "coach.fmu"
    texts = [path for path in map(Path, ("LICENSE-MIT", "LICENSE-APACHE", "docs/LICENSE-THIRD-PARTY")) if path.is_file()]
    ssp.pack_coach(options.coach / "coach", options.coach / "libcoach.so", coach, texts)
    with Fmu(options.fmu) as wheel, Fmu(coach) as opened:
        written = ssp.write(scenario, wheel, opened, (options.fmu, coach), options.out, options.stop, options.step)
    print("written:", ", ".join(map(str, (coach, *written))))


def rigid(scenario):
    """Says what rigid wheelsets leave out of the parameters of the wheels. Names are those of the FMU, if there is one."""
    from .wheelset import LAW, FrictionLaw

    if default_path().is_file():
        with Fmu() as known:
            scenarios.check_wheel(scenario, [v.name for v in known.description.modelVariables if v.causality == "parameter"])
    FrictionLaw.of(scenario.wheel | scenario.sweep.wheel)
    ignored = [name for name in scenario.wheel | scenario.sweep.wheel if name not in LAW]
    if ignored:
        print(f"rigid wheelsets know {' and '.join(LAW)} only; without effect: {', '.join(ignored)}", file=sys.stderr)


def main(argv=None):
    """Runs a command; errors of files and of the FMU become one line."""
    options = arguments(argv)
    if options.command == "schema":
        print(json.dumps(json_schema(scenarios.SCHEMAS[options.kind]), indent=2))
        return
    try:
        if options.command in analysis.COMMANDS:
            analysis.run(options)
            return
        if options.command == "report":
            page.run(options)
            return
        scenario = scenarios.load(options.scenario)
        if options.command == "ssp":
            packages(options, scenario)
            return
        if options.step is not None:
            wrong = scenarios.SCENARIO["step"].check(options.step)
            if wrong:
                raise BadFile(f"--step {wrong}")
            scenario.step = options.step
        if options.rigid:
            rigid(scenario)
        if options.command == "train":
            train(options, scenario)
        else:
            from .sweep import run

            run(options, scenario)
    except (BadFile, FileNotFoundError, Refused, TimeoutError) as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()
