"""What stands where on the page of a run and on that of the stops of a train."""

import json
import re

import numpy as np

from .. import report
from ..fmu import known_unit
from . import balance, charts, film, html, stops
from .units import CELSIUS, KMH, PERCENT, Shown, number, shown

MOMENT = re.compile(r"^t = ([\d.e+-]+) s: ")  # with which the FMU begins its warnings
CREDIT = "Drawn by plotly.js (MIT licence, © Plotly), which is inside this file; nothing is loaded from anywhere."


def run_page(run, when):
    """The page of a run."""
    patch, depth = film.of_run(run), film.fields(run)
    parts = [html.head(run.title, _subtitle(run, when), tiles(run)), html.EMPTY]
    told = warnings(run)
    if told:
        parts.append(html.section("warnings", "Warnings", html.notice(told)))
    along, across = bool(patch and "pressure" in patch), bool(patch and "lines" in patch)
    if along:
        parts.append(
            html.section("patch", "The contact patch", f'<div class="pair">{html.FILM}{html.MAP}</div>', _film_note(run, patch))
        )
    if across:
        readings = "" if along else html.READINGS
        parts.append(html.section("lines", "The contact patch from above", readings + html.ABOVE, _above_note(patch, along)))
    curves, others = charts.of_run(run)
    first, rest = charts.sorted_out(curves)
    parts.append(html.section("curves", "Speeds and forces", html.charts(), _curves_note(run, bool(patch))))
    if depth or any(chart.get("room") for chart in first):
        parts.append(html.section("heat", "Temperatures", html.charts(charts.HOT) + html.charts("fields")))
    if run.damage:
        parts.append(html.section("damage", "Damage", _damage(run.damage), _damage_note(run.damage)))
    if rest or others:
        parts.append(html.section("rest", f"{len(rest) + len(others)} more figures over time", html.charts("more"), folded=True))
    found = balance.of_run(run)
    if found:
        parts.append(html.section("balances", "Balances at the end", "".join(map(_balance, found)), folded=True))
    parts.append(html.section("settings", "What was set", settings(run), folded=True))
    parts.append(html.section("quantities", f"{len(run.series)} quantities: range and meaning", quantities(run), folded=True))
    parts.append(html.BAR if patch else "")
    parts.append(f"<footer><p>{html.escape(CREDIT)}</p></footer>")
    below = damage_charts(run.damage) if run.damage else []
    data = {"views": {"": first}, "more": rest + others, "overview": below, "film": patch, "fields": depth}
    return html.document(run.title, "\n".join(parts), data)


def stops_page(title, found, about, when):
    """The page of stops: `found` is name to table, `about` rows of texts."""
    first, title = next(iter(found.values())), title[:1].upper() + title[1:]
    longest = [(name, stops.reached(s)) for name, s in found.items()]
    parts = [html.head(title, f"{len(found)} stops, {len(report.axles_of(first))} axles, written {when}", longest), html.EMPTY]
    parts.append(html.section("overview", "Side by side", html.charts("together")))
    note = "One figure for each axle, the leading one first. Slide is (V − rω)/V."
    parts.append(html.section("figures", "Key figures", html.table(stops.figures(found), "numbers"), note))
    choice = html.choices(found) if len(found) > 1 else ""
    parts.append(
        html.section("curves", "Over time", choice + html.charts(), "Zoom in one figure zooms all; a click on a name hides it.")
    )
    if about:
        parts.append(html.section("settings", "Scenario", html.table(list(about), "pairs", header=False)))
    parts.append(f"<footer><p>{html.escape(CREDIT)}</p></footer>")
    views = {name: stops.charts(stop, found.values()) for name, stop in found.items()}
    data = {"views": views, "more": [], "overview": stops.side_by_side(found), "film": None, "fields": []}
    return html.document(title, "\n".join(parts), data)


def _subtitle(run, when):
    """Preset, version, number of samples."""
    about = run.about
    words = [f"preset {about['preset']}"] if about.get("preset") else []
    words += [f"wheelrail {about['fmu_version']}"] if about.get("fmu_version") else []
    steps = np.diff(run.time)
    every = f"every {number(1e3 * float(np.median(steps)))} ms" if len(steps) else ""
    return ", ".join([*words, f"{len(run.time)} samples {every}".strip(), f"written {when}"])


def tiles(run):
    """Key figures: label and value, as far as the run has them."""
    get, own = run.get, run.about.get("figures")
    found = [tuple(row) for row in own or [("duration", f"{number(float(run.time[-1] - run.time[0]))} s")]]
    v = get("wheel.velocity")
    if v is not None:
        found.append(("speed", f"{number(float(KMH(v[0])), 3)} → {number(round(float(KMH(v[-1])), 2), 3)} km/h"))
    if run.has("wheel.distance") and not own:
        found.append(("distance", f"{number(float(get('wheel.distance')[-1] - get('wheel.distance')[0]))} m"))
    if v is not None and run.has("contact.creepage"):
        rolls = np.abs(v) > min(charts.ROLLING, 0.05 * np.abs(v).max())
        if rolls.any():
            found.append(("largest creepage", PERCENT.text(np.nanmax(np.abs(get("contact.creepage")[rolls])))))
    if run.has("contact.utilisation"):
        found.append(("largest use of friction", PERCENT.text(np.nanmax(get("contact.utilisation")))))
    hot = [np.nanmax(get(n)) for n in ("temperature.wheel_max", "temperature.rail_max") if run.has(n) and np.any(get(n))]
    if hot:
        found.append(("hottest contact", CELSIUS.text(max(hot))))
    if run.has("energy.friction"):
        end = get("energy.friction")[-1:]
        found.append(("friction energy", shown("J", end).text(end[0])))
    if run.has("damage.martensite_depth") and get("damage.martensite_depth")[-1] > 0.0:
        end = get("damage.martensite_depth")[-1:]
        found.append(("depth of martensite", shown("m", end).text(end[0])))
    if run.has("solver.energy_residual"):
        found.append(("energy residual", PERCENT.text(abs(get("solver.energy_residual")[-1]))))
    return found


def warnings(run):
    """Texts of warnings, with the time where it is known, and of steps whose error was let pass."""
    found = []
    for entry in run.about.get("warnings") or []:
        if isinstance(entry, dict):
            entry = (entry.get("time"), MOMENT.sub("", entry.get("text", "")))
        if isinstance(entry, (list, tuple)) and len(entry) == 2:
            found.append(f"at {number(float(entry[0]))} s: {entry[1]}" if entry[0] is not None else str(entry[1]))
        else:
            found.append(MOMENT.sub(lambda t: f"at {number(float(t[1]))} s: ", str(entry)))
    limited = run.get("solver.limited_steps")
    if limited is not None and np.nansum(limited):
        limited = np.nan_to_num(limited)
        first = run.time[int(np.flatnonzero(limited)[0])]
        found.append(
            f"at {number(float(first))} s and later: {int(limited.sum())} internal steps exceed solver.tolerance, because"
            " solver.max_internal_steps allows no shorter ones"
        )
    return found


def _film_note(run, patch):
    note = "Travel is to the right. The friction limit is contact.friction × pressure: where the surfaces slip, shear lies on it"
    melts = run.has("damage.melted") and run.get("damage.melted").any()
    note += ", less where steel melts and its film lubricates." if melts else "."
    if patch["of"] > len(patch["time"]):
        note += f" {len(patch['time'])} of {patch['of']} recorded instants, extremes kept."
    if patch["window"]:
        note += " The map begins with the hot part of the run; a double click shows all of it."
    return note + " A click on the map or on a curve shows the patch at that time."


def _above_note(patch, along):
    known = "state" in patch["lines"]["grid"]["quantities"]
    note = "What the lines of the patch have, interpolated between them; travel is to the right."
    if not known:
        note += (
            " Pressure is drawn as half an ellipse along each line. What sticks is drawn in one piece from the leading edge: the share"
            " of the line that sticks, not where it does. A record with patch=True has both as they are."
        )
    if not along and patch["of"] > len(patch["time"]):
        note += f" {len(patch['time'])} of {patch['of']} recorded instants, extremes kept."
    return note


def _curves_note(run, patch):
    note = "Zoom in one figure zooms all; a click on a name hides or shows it."
    if len(run.time) > 2 * charts.POINTS:
        note += f" Curves are thinned from {len(run.time)} samples; lowest and highest values are kept."
    return note + (" The vertical line is the time of the film." if patch else "")


def _damage(found):
    """Findings, figures over the depth, and what others observed."""
    tables = html.table(found.rows(), "findings", header=False)
    if found.comparisons():
        tables += html.table([("observed by others", "here", "source"), *found.comparisons()])
    return f'<div class="columns">{tables}</div>' + html.charts("together")


def _damage_note(found):
    note = "The most of all places of the tread that the contact heated while the wheel stood still, or nearly so."
    return note if found.final else note + " Steel still cools: the findings may change, and hardness is that of what is cold."


def damage_charts(found):
    """Highest temperature, martensite and hardness over the depth, down to where something has changed; the last two where steel is cold."""
    deep = int(np.flatnonzero(found.peak > found.peak.min() + 0.02 * np.ptp(found.peak)).max(initial=1)) + 2
    depth = 1e3 * found.depth[:deep]
    rows = (
        ("Highest temperature over the depth", CELSIUS, found.peak), ("Martensite over the depth", PERCENT, found.martensite),
        ("Hardness over the depth", Shown("HV"), found.hardness),
    )  # fmt: skip
    rows = rows if found.final or found.martensite.any() else rows[:1]
    curve = lambda k, unit, values: charts.trace(depth, unit(values[:deep]), "end of the run", k + 1)
    return [charts.chart(title, unit.label, [curve(k, unit, v)], x="depth [mm]") for k, (title, unit, v) in enumerate(rows)]


def _balance(found):
    """A table of a balance."""
    rows = [(text, shown(found.unit, [v]).text(v)) for text, v in found.rows]
    body = html.table(rows, "sum", header=False)
    words = f'<p class="note">{html.escape(found.meaning)}</p>'
    return f"<article><h3>{html.escape(found.title)}</h3>{body}{words}</article>"


def settings(run):
    """Parameters that differ from the preset, constant inputs, and whatever else the record says."""
    preset = run.about.get("preset", "")
    parts = []
    for key, heading in (
        ("parameters", f"Parameters that differ from the preset {preset}".strip()),
        ("inputs", "Constant inputs"),
    ):
        given = run.about.get(key)
        if given:
            rows = [(name, _setting(name, value)) for name, value in given.items() if name != "preset"]
            parts.append(f"<div><h3>{heading}</h3>{html.table(rows, 'pairs', header=False)}</div>")
        elif given is not None:
            parts.append(f"<div><h3>{heading}</h3><p>none</p></div>")
    still = charts.constant(run)
    if still:
        rows = [(name, shown(unit, [value]).text(value)) for name, (value, unit) in still.items()]
        parts.append(f"<div><h3>What never changed</h3>{html.table(rows, 'pairs', header=False)}</div>")
    if not any(run.about.get(key) is not None for key in ("parameters", "inputs")):
        parts.insert(0, '<p class="note">This file does not say which parameters were set; a record (NetCDF) does.</p>')
    if run.about.get("note"):
        parts.append(f'<p class="note">{html.escape(str(run.about["note"]))}</p>')
    return f'<div class="columns">{"".join(parts)}</div>'


def _setting(name, value):
    """A value as the FMU takes it, in SI units; absolute temperatures in °C beside it."""
    text = value if isinstance(value, str) else json.dumps(value) if not isinstance(value, float) else f"{value:.9g}"
    return f"{text} K = {CELSIUS.text(value)}" if known_unit(name, shown=True) == "degC" and isinstance(value, (int, float)) else text


def quantities(run):
    """A table of all quantities: least, largest, last value, meaning."""
    rows = [("name", "least", "largest", "at the end", "meaning")]
    for name, s in run.series.items():
        if np.isfinite(s.values).any():
            unit = shown(s.unit, s.values)
            rows.append((name, *(unit.text(v) for v in (np.nanmin(s.values), np.nanmax(s.values), s.values[-1])), s.meaning))
    return html.table(rows, "quantities")
