"""Picture of a braking stop: the whole stop, its slide, and the contact patch in three moments."""

import numpy as np

from wheelrail.plots import COLOURS, GREY, Picture, save

KELVIN = 273.15  # K at 0 °C
SLIDING = 0.01  # creepage
ROLLING = 1.0  # m/s, below which creepage says nothing
BEFORE, AFTER = 0.15, 0.35  # s that are shown around a slide
BLUE, ORANGE, INK, SHADE = *COLOURS[:2], "#1f2933", "#f3ead8"
GLOW = ("#e8edf2", "#fdd49e", "#fc8d59", "#d7301f", "#5c0000")  # from cold to hot
HIGHEST = 1450.0  # MPa, of the axis


def draw(path, table, film, radius):
    """Draws the stop and returns its figure: `table` has outputs over time by name, `film` profiles across the patch, `radius` [m] is
    the wheel's."""
    from matplotlib.colors import LinearSegmentedColormap, Normalize

    figure = Picture(figsize=(8, 7.4))
    grid = figure.add_gridspec(4, 3, height_ratios=(0.9, 1.0, 1.3, 1.4))
    hot = max(film.profile("temperature_wheel").max() - KELVIN, 200.0)
    colours = {"cmap": LinearSegmentedColormap.from_list("glow", GLOW), "norm": Normalize(0.0, hot)}
    window, shown = slide(table), moments(table)
    friction, temperatures = figure.add_subplot(grid[1, :]), figure.add_subplot(grid[2, :])
    _speed(figure.add_subplot(grid[0, :]), table, radius, window)
    _friction(friction, table, window)
    _temperatures(temperatures, table, film, window, colours)
    patches = [figure.add_subplot(grid[3, k]) for k in range(len(shown))]
    for k, (axis, (time, title)) in enumerate(zip(patches, shown)):
        _patch(axis, table, film, time, colours)
        axis.set_title(f"$\\bf{{{k + 1}}}$  {title}")
        for over_time in (friction, temperatures):
            over_time.axvline(time, color=INK, linewidth=0.8, linestyle=(0, (2, 2)))
        friction.annotate(f"$\\bf{{{k + 1}}}$", (time, 1.0), (0, 2), xycoords=("data", "axes fraction"),
                          textcoords="offset points", ha="center", va="bottom", fontsize=10)  # fmt: skip
    patches[0].set_ylabel("stress [MPa]")
    figure.legend(*patches[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    save(path, figure)
    return figure


def slide(table):
    """Start and end [s] of what is shown closely: the longest slide and its surroundings, or the whole stop."""
    slides = (np.abs(table["contact.creepage"]) > SLIDING) & (table["wheel.velocity"] > ROLLING)
    edges = np.flatnonzero(np.diff(np.concatenate(([0], slides, [0]))))
    if len(edges) == 0:
        return table["time"][0], table["time"][-1]
    start, end = max(edges.reshape(-1, 2), key=lambda pair: pair[1] - pair[0])
    return table["time"][start] - BEFORE, table["time"][end - 1] + AFTER


def moments(table):
    """Three times [s] with their titles: before, on and behind leaves; without these, three speeds."""
    time, speed, friction = table["time"], table["wheel.velocity"], table["rail.friction"]
    leaves = np.flatnonzero(friction < friction[0])
    locked = np.flatnonzero((table["wheel.omega"] == 0.0) & (speed > ROLLING))
    if len(leaves) == 0 or len(locked) == 0 or locked[-1] <= leaves[-1]:
        at = [np.flatnonzero(speed < share * speed[0])[0] for share in (0.75, 0.5, 0.25)]
        return [(time[i], f"at {3.6 * speed[i]:.0f} km/h") for i in at]
    at = [np.searchsorted(time, time[leaves[0]] - 0.5 * BEFORE), (locked[0] + leaves[-1]) // 2, locked[-1]]
    return list(zip(time[at], ("brakes, rolling", "locked, on leaves", "locked, on dry rail")))


def _speed(axis, table, radius, window):
    """Speeds of vehicle and tread over the whole stop."""
    time = table["time"]
    axis.axvspan(*window, color=SHADE, linewidth=0)
    axis.plot(time, 3.6 * table["wheel.velocity"], color=BLUE, label="wheel travels")
    axis.plot(time, 3.6 * radius * table["wheel.omega"], color=ORANGE, linestyle="--", label="its tread turns")
    axis.set(ylabel="speed [km/h]", xlabel="time [s]", xlim=(0, time[-1]), ylim=(0, None))
    axis.set_title("A wheel brakes to standstill. Below: what is shaded here")
    axis.legend(loc="upper right")


def _friction(axis, table, window):
    """Friction used, that of the cold rail, and what the heat leaves of it."""
    time = table["time"]
    near = (time >= window[0]) & (time <= window[1])
    used = np.abs(table["contact.force_x"]) / np.maximum(table["contact.force_y"], 1.0)
    axis.plot(time[near], table["rail.friction"][near], color=GREY, linestyle=":", label="of the cold rail")
    axis.plot(time[near], table["contact.friction"][near], color=ORANGE, label="of the hot contact")
    axis.plot(time[near], used[near], color=BLUE, linestyle="--", label="used by the wheel")
    axis.set(ylabel="friction [1]", xlim=window, ylim=(0, None))
    axis.tick_params(labelbottom=False)
    axis.legend(loc="best")


def _temperatures(axis, table, film, window, colours):
    """Temperature of the tread across the patch over time."""
    times = np.array(film.times)
    near = np.flatnonzero((times >= window[0] - 0.2) & (times <= window[1] + 0.2))
    field, place = film.profile("temperature_wheel")[near].T - KELVIN, 1e3 * film.profile("x")[near[0]]
    image = axis.pcolormesh(times[near], place, field, shading="gouraud", rasterized=True, **colours)
    width = 1e3 * np.interp(times[near], table["time"], table["contact.half_width"])
    for sign in (-1.0, 1.0):
        axis.plot(times[near], sign * width, color=INK, linewidth=0.8)
    axis.set(ylabel="x [mm]", xlabel="time [s]", xlim=window)
    axis.grid(False)
    axis.set_title("Temperature of the tread in the contact, whose edges are the lines (travel upwards)")
    scale = axis.figure.colorbar(image, cax=axis.inset_axes([0.92, 0.1, 0.015, 0.72]))
    scale.ax.tick_params(labelsize=9)
    scale.ax.set_title("°C", loc="center", fontsize=9, pad=3)


def _patch(axis, table, film, time, colours):
    """Pressure, shear and limit of friction in a moment; the fill has the colour of the tread's temperature."""
    frame = int(np.argmin(np.abs(np.array(film.times) - time)))
    x, pressure, shear, tread = (film.profile(name)[frame] for name in ("x", "pressure", "shear", "temperature_wheel"))
    friction = table["contact.friction"][np.argmin(np.abs(table["time"] - film.times[frame]))]
    x, pressure, shear = 1e3 * x, pressure / 1e6, np.abs(shear) / 1e6
    extent = (x[0], x[-1], 0.0, pressure.max())
    image = axis.imshow(tread[None, :] - KELVIN, extent=extent, aspect="auto", interpolation="bilinear", **colours)
    image.set_clip_path(axis.fill_between(x, pressure, color="none").get_paths()[0], axis.transData)
    axis.plot(x, pressure, color=INK, label="pressure")
    axis.plot(x, shear, color=BLUE, label="shear")
    axis.plot(x, friction * pressure, color=INK, linestyle=":", label=r"limit of friction $\mu p$")
    axis.set(xlabel="x [mm]", xlim=(x[0], x[-1]), ylim=(0, HIGHEST))
    text = f"up to {tread.max() - KELVIN:.0f} °C, $\\mu$ = {friction:.2f}"
    axis.text(0.03, 0.96, text, transform=axis.transAxes, ha="left", va="top")
