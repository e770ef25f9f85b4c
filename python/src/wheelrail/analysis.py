"""Commands that answer questions about results: `python -m wheelrail force | spectrum | octaves | flat | filter`.

Results are CSV files with a header, such as `wheelrail simulate --out run.csv` writes; profiles of rail and wheel as well.
"""

import difflib
from pathlib import Path

import numpy as np

from . import signals, surfaces, units
from .fmu import known_unit
from .output import beside, write_columns, write_rows
from .tables import BadFile, headings_of, number_in, read_table
from .units import UnitError, converted, headed, named

FORCE = "contact.force_y"
KNOWN = {"time": "s", "position": "m", "height": "m"}  # units of columns that are no variables of the FMU
SHARES = (0.5, 0.9, 0.99, 0.999)  # of time, of which the level that is not exceeded is printed


def read_columns(path, names):
    """Columns of a CSV file by name, as arrays in SI units; names may have units beside them, `force [kN]`."""
    headings, head, lines = read_table(path)
    header, of = zip(*(named(heading, names) for heading in headings))
    for name in names:
        if name not in header:
            near = difflib.get_close_matches(name, header, n=3) or header[:8]
            raise BadFile(f"{path}:{head}: column {name} is missing; nearest: {', '.join(near)}")
    columns = [header.index(name) for name in names]
    table = [[number_in(path, line, header[k], row[k]) for k in columns] for line, row in lines]
    if not table:
        raise BadFile(f"{path}: only a header; rows are needed")
    try:
        return [_in_si(name, values, of[k]) for name, k, values in zip(names, columns, np.array(table).T)]
    except UnitError as error:
        raise BadFile(f"{path}:{head}: {error}") from None


def add_command(commands):
    """Declares the commands."""
    about = {
        "force": "statistics of a column over time: moments, probability density, exceedance",
        "spectrum": "amplitude of a column against frequency",
        "octaves": "one-third octaves of a column, or of a profile with the columns position,height",
        "flat": "largest force of every turn of the wheel against speed",
        "filter": "contact filter of a Hertzian line contact beside that of CNOSSOS-EU",
    }
    made = {name: commands.add_parser(name, help=text, description=text) for name, text in about.items()}
    for name in ("force", "spectrum", "octaves", "flat"):
        made[name].add_argument("file", type=Path, help="CSV file with a header")
        made[name].add_argument("--column", default=FORCE, help="default: %(default)s")
        made[name].add_argument("--over", default="time", help="column of time or position, default: %(default)s")
        made[name].add_argument("--begin", type=float, default=-np.inf, help="time or position from which on it counts")
    for name in ("spectrum", "octaves"):
        made[name].add_argument("--step", type=float, help="resample at this distance first")
    made["octaves"].add_argument("--reference", type=float, help="of 0 dB; default: 1e-6 for heights, 1 otherwise")
    made["octaves"].add_argument("--periodic", action="store_true", help="the file holds one whole period: no window")
    made["filter"].add_argument("--half-width", type=float, default=7.16e-3, help="of the contact [m], default: %(default)s")
    for command in made.values():
        command.add_argument("--out", type=Path, default=Path("results"), help="directory, default: %(default)s")


def run(options):
    """Runs a command: a table on the screen, a CSV and a picture."""
    try:
        header, rows, lines, draw = COMMANDS[options.command](options)
    except signals.BadSignal as error:
        raise BadFile(f"{options.file}: {error}") from error
    table, picture = (options.out / f"{options.command}.{kind}" for kind in ("csv", "png"))
    write_rows(table, [header, *([f"{value:.9g}" for value in row] for row in rows)])
    columns = beside(table, "columns")
    write_columns(columns, [(column, *told(column, options)) for column in header])
    save(picture, draw)
    print("\n".join(lines))
    print(f"written: {table}, {columns}, {picture}")


def told(column, options):
    """Unit and meaning of a column that a command writes; where it follows from that of the file, in its words."""
    of, over = getattr(options, "column", ""), getattr(options, "over", "")
    found = {
        "density": (f"1/({unit_of(of)})", "probability density over time of the first column"),
        "exceedance": ("1", "share of time in which the first column is above its value"),
        "frequency": (f"1/({unit_of(over)})", "middle of the band, or the line of the spectrum"),
        "amplitude": (unit_of(of), f"amplitude of {of}"), "wavelength": ("m", "of the surface"),
        "level": ("dB", f"level of {of}"), "limit": ("dB", "EN ISO 3095:2013"), "speed": ("m/s", "mean of a turn"),
        "largest": (unit_of(of), f"largest {of} of a turn"), "smallest": (unit_of(of), f"smallest {of} of a turn"),
        "share_without_contact": ("1", "share of the turn in which nothing touches"),
        "filter": ("dB", "contact filter of a line contact"), "cnossos": ("dB", "that of CNOSSOS-EU"),
    }  # fmt: skip
    return found.get(column, (unit_of(column), "column of the file"))


def unit_of(name):
    """SI unit of a variable of the FMU by its name, or what to take for it."""
    return KNOWN.get(name) or known_unit(name) or f"unit of {name}"


def _in_si(name, values, unit):
    """Values of a column in SI units; where neither its name nor its unit says these, as they are."""
    expected = KNOWN.get(name) or known_unit(name)
    if unit is None or expected:
        return converted(name, values, unit, expected)
    try:
        return units.unit_of(unit).to_si(values)
    except UnitError:
        return values


def save(path, draw):
    """A picture of one diagram."""
    from . import plots

    figure, axis = plots.subplots(figsize=(6.4, 4.0))
    draw(axis)
    plots.save(path, figure)


def _signal(options):
    """Column of time or position and column of values, from where they count."""
    if options.command == "octaves" and options.over == "time" and options.column == FORCE:
        if {"position", "height"} <= {headed(heading)[0] for heading in headings_of(options.file)}:
            options.over, options.column = "position", "height"
    over, values = read_columns(options.file, (options.over, options.column))
    kept = over >= options.begin
    over, values = signals.checked(over[kept], values[kept])
    return (over, values) if getattr(options, "step", None) is None else signals.resampled(over, values, options.step)


def _force(options):
    """Statistics, density and exceedance."""
    time, values = _signal(options)
    found = signals.statistics(time, values)
    edges, density = signals.density(time, values)
    levels, above = signals.exceedance(time, values)
    lines = [f"{options.column} over {time[-1] - time[0]:.4g} s, {len(time)} samples", ""]
    words = {"deviation": "standard deviation", "least": "smallest", "at_zero": "share of time at or below zero"}
    lines += [f"{words.get(name, name):32s} {value:14.6g}" for name, value in vars(found).items()]
    level = lambda share: levels[min(int(np.searchsorted(-above, share - 1.0)), len(levels) - 1)]  # not exceeded for a share of the time
    lines += [f"{f'not exceeded {100 * q:g} % of the time':32s} {level(q):14.6g}" for q in SHARES]
    rows = [(0.5 * (low + high), share, np.interp(0.5 * (low + high), levels, above)) for low, high, share in zip(edges, edges[1:], density)]

    def draw(axis):
        axis.stairs(density, edges, fill=True, alpha=0.3)
        axis.set(xlabel=options.column, ylabel="probability density", yscale="linear")
        other = axis.twinx()
        other.semilogy(levels, np.maximum(above, 0.5 / len(levels)), color="#D55E00")
        other.set(ylabel="share of time above")
        other.grid(False)

    return (options.column, "density", "exceedance"), rows, lines, draw


def _spectrum(options):
    """Amplitude against frequency."""
    frequency, amplitude = signals.amplitudes(*_signal(options))
    largest = np.argsort(amplitude[1:])[::-1]
    peaks = [k + 1 for k in largest if amplitude[k + 1] >= max(amplitude[k], amplitude[min(k + 2, len(amplitude) - 1)])][:8]
    lines = [f"largest amplitudes of {options.column}", "", f"{'frequency':>14s} {'amplitude':>14s}"]
    lines += [f"{frequency[k]:14.6g} {amplitude[k]:14.6g}" for k in peaks]

    def draw(axis):
        axis.loglog(frequency[1:], amplitude[1:])
        axis.set(xlabel=f"frequency [1/unit of {options.over}]", ylabel=f"amplitude of {options.column}")

    return ("frequency", "amplitude"), list(zip(frequency, amplitude)), lines, draw


def _octaves(options):
    """One-third octaves; of a profile beside the limit of EN ISO 3095."""
    over, values = _signal(options)
    profile = options.over == "position"
    reference = (1e-6 if profile else 1.0) if options.reference is None else options.reference
    if not 0.0 < reference < np.inf:
        raise BadFile(f"--reference = {reference:g} is not above zero")
    if options.periodic:
        # A file of one whole period may repeat its first place at the end.
        if len(values) > 3 and np.isclose(values[0], values[-1], rtol=1e-9, atol=0.0):
            over, values = over[:-1], values[:-1]
    frequency, level = signals.octaves(over, values, reference, "boxcar" if options.periodic else "hann")
    if profile:
        limit = [surfaces.EN_ISO_3095.get(round(-10.0 * np.log10(f)), np.nan) for f in frequency]
        lines = [f"{'wavelength [m]':>14s} {'level [dB]':>12s} {'EN ISO 3095':>12s}"]
        rows = list(zip(1.0 / frequency, level, limit))[::-1]
    else:
        lines, rows = [f"{'frequency':>14s} {'level [dB]':>12s}"], list(zip(frequency, level))
    lines += [f"{row[0]:14.4g} " + " ".join(f"{value:12.2f}" for value in row[1:]) for row in rows]

    def draw(axis):
        x = np.array([row[0] for row in rows])
        axis.semilogx(x, [row[1] for row in rows], "o-", label=options.column)
        if profile:
            axis.semilogx(x, [row[2] for row in rows], "k--", label="EN ISO 3095:2013")
            axis.invert_xaxis()
            axis.legend()
        axis.set(xlabel="wavelength [m]" if profile else "frequency", ylabel=f"level [dB re {reference:g}]")

    return ("wavelength", "level", "limit") if profile else ("frequency", "level"), rows, lines, draw


def _flat(options):
    """Largest force of every turn against speed."""
    over, omega, velocity, force = read_columns(options.file, (options.over, "wheel.omega", "wheel.velocity", options.column))
    kept = over >= options.begin
    rows = signals.of_turns(*(column[kept] for column in (over, omega, velocity, force)))
    lines = [f"{'speed [km/h]':>14s} {'largest':>14s} {'smallest':>14s} {'no contact':>12s}"]
    lines += [f"{3.6 * v:14.2f} {most:14.6g} {least:14.6g} {100 * off:10.2f} %" for v, most, least, off in rows]

    def draw(axis):
        axis.plot(3.6 * rows[:, 0], rows[:, 1], "o-", label="largest")
        axis.plot(3.6 * rows[:, 0], rows[:, 2], "o-", label="smallest")
        axis.set(xlabel="speed [km/h]", ylabel=f"{options.column} of a turn")
        axis.legend()

    return ("speed", "largest", "smallest", "share_without_contact"), rows, lines, draw


def _filter(options):
    """Contact filter."""
    if not 1e-5 <= options.half_width <= 0.1:
        raise BadFile(f"--half-width = {options.half_width:g} m is outside 1e-05 to 0.1 m")
    table = np.array(surfaces.CNOSSOS)
    level = surfaces.contact_filter_level(options.half_width, table[:, 0])
    rows = list(zip(table[:, 0], level, table[:, 1]))
    null = options.half_width / surfaces.FIRST_NULL
    lines = [f"half-width {options.half_width:g} m, first null at a wavelength of {null:.4g} m", ""]
    lines += [f"{'wavelength [m]':>14s} {'J0 [dB]':>10s} {'CNOSSOS [dB]':>13s}"]
    lines += [f"{x:14.4g} {a:10.2f} {b:13.2f}" for x, a, b in rows]

    def draw(axis):
        x = np.geomspace(0.5 * null, 0.2, 600)
        axis.semilogx(x, np.maximum(surfaces.contact_filter_level(options.half_width, x), -40.0), label="J0 of a line contact")
        axis.semilogx(table[:, 0], table[:, 1], "ko", label="CNOSSOS-EU, 100 kN, 920 mm")
        axis.set(xlabel="wavelength [m]", ylabel="contact filter [dB]")
        axis.legend()

    return ("wavelength", "filter", "cnossos"), rows, lines, draw


COMMANDS = {"force": _force, "spectrum": _spectrum, "octaves": _octaves, "flat": _flat, "filter": _filter}
