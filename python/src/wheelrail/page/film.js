// The contact patch over time: the film, the map of it, the bar that moves both.

const STICKS = 1,
  SLIPS = 2;
const TITLES = {
  temperature_wheel: "temperature of the wheel",
  temperature_rail: "temperature of the rail",
  pressure: "pressure",
  shear: "shear",
  slip: "slip",
  state: "stick and slip",
  shear_z: "lateral shear",
  slip_z: "lateral slip",
};

// Values of a quantity of the patch from above, packed as whole numbers: rows over z at every frame; null where unknown.
function unpackedGrid(grid) {
  const cells = grid.x.length * grid.z.length,
    found = {};
  for (const [name, { packed, low, high, levels }] of Object.entries(grid.quantities)) {
    const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0)),
      whole = new Uint16Array(bytes.buffer),
      value = (n) => (n > levels ? null : low + (n / levels) * (high - low)),
      row = (from) => Array.from(whole.subarray(from, from + grid.x.length), value);
    found[name] = (frame) => grid.z.map((_, k) => row(frame * cells + k * grid.x.length));
  }
  return found;
}

// Rows between rows and places between places: linear, or those of the nearest for states, of which one that touches comes first.
function finer(rows, times, nearest) {
  const spread = (n) => Array.from({ length: times * (n - 1) + 1 }, (_, k) => k / times);
  const linear = (a, b, share) => (share === 0 ? a : a === null || b === null ? null : a + share * (b - a));
  const mixed = nearest ? (a, b, share) => (share < 0.5 ? a || b : b || a) : linear;
  const along = rows.map((row) =>
    spread(row.length).map((k) => mixed(row[Math.floor(k)], row[Math.min(Math.floor(k) + 1, row.length - 1)], k % 1)),
  );
  return spread(rows.length).map((k) => {
    const low = along[Math.floor(k)],
      high = along[Math.min(Math.floor(k) + 1, rows.length - 1)];
    return low.map((v, i) => mixed(v, high[i], k % 1));
  });
}

// Colours of a quantity of the patch from above.
function aboveScale(key, low, high, most) {
  const [stick, slip] = ["--stick", "--slip"].map(colour);
  if (key === "state") {
    const colorscale = [stick, stick, slip, slip].map((c, k) => [[0, 0.5, 0.5, 1][k], c]);
    return { colorscale, zmin: 0.5, zmax: 2.5, zsmooth: false };
  }
  const size = Math.max(Math.abs(low), Math.abs(high)) || 1;
  if (key.startsWith("shear") || key.startsWith("slip")) return { colorscale: "RdBu", zmin: -size, zmax: size, zsmooth: "best" };
  return { colorscale: key.startsWith("temp") ? INFERNO : "Viridis", zmin: low, zmax: Math.max(most, low + 1e-9), zsmooth: "best" };
}

function extent(...tables) {
  let low = Infinity,
    high = -Infinity;
  for (const table of tables)
    for (const row of table || [])
      for (const v of row)
        if (v !== null) {
          low = Math.min(low, v);
          high = Math.max(high, v);
        }
  const room = 0.06 * (high - low) || Math.abs(high) * 0.1 || 1;
  return [low - room, high + room];
}

// A row at other places, linear between those given.
function resampled(x, row, grid) {
  let k = 0;
  return grid.map((g) => {
    while (k < x.length - 2 && x[k + 1] < g) k++;
    const share = (g - x[k]) / (x[k + 1] - x[k]);
    return share < 0 || share > 1 ? null : row[k] + share * (row[k + 1] - row[k]);
  });
}

function depthMap(field, time) {
  const data = [
    {
      type: "heatmap",
      x: field.time,
      y: field.depth,
      z: field.values,
      colorscale: INFERNO,
      zsmooth: "best",
      colorbar: { title: { text: "°C" }, thickness: 12 },
      hovertemplate: "%{x:.4~g} s, %{y:.3~g} mm: %{z:.4~g} °C<extra></extra>",
    },
  ];
  const look = {
    xaxis: axis("time [s]"),
    yaxis: axis("depth [mm]", { autorange: "reversed" }),
    hovermode: "closest",
    shapes: time === null ? [] : [cursor(time)],
  };
  return { data, layout: layout(look) };
}

// Where the patch from above and the temperatures of its lines stand: side by side, or on a narrow page one below the other.
function placesAbove(heat) {
  if (!heat) return { x: [0, 1], y: [0, 1], bar: { x: 1.02 } };
  if ($("#above").clientWidth >= 560) return { x: [0, 0.58], y: [0, 1], bar: { x: 0.6 }, heat: { x: [0.72, 1] } };
  return { x: [0, 1], y: [0.5, 1], bar: { x: 1.02, y: 0.75, len: 0.5 }, heat: { x: [0, 1], y: [0, 0.3] } };
}

// The patch from above: a quantity over x and z, its outline, where it sticks; with it the hottest place of each line.
function patchFromAbove(lines, grid, key, frame, fit) {
  const row = (key) => lines[key][frame],
    z = row("z"),
    a = row("half_length"),
    edges = row("edges"),
    { unit, low, high } = lines.grid.quantities[key],
    side = lines.ahead[frame],
    places = placesAbove(lines.temperature_wheel || lines.temperature_rail);
  const most = (table) => Math.max(...table.flat()),
    reach = 1.06 * (fit ? Math.max(...a) : most(lines.half_length)) || 1,
    across = 1.06 * (fit ? Math.max(...edges) : most(lines.edges)) || 1;
  const times = lines.grid.finer,
    [columns, rows] = [lines.grid.x, lines.grid.z].map((row) => finer([row, row], times, false)[0]),
    [trailing, leading] = lines.grid.rim[frame],
    within = (v, i, j) => (columns[i] > trailing[j] && columns[i] < leading[j] ? v : null),
    all = finer(grid[key](frame), times, key === "state"),
    values = key.startsWith("temp") ? all : all.map((line, j) => line.map((v, i) => within(v, i, j)));
  const touching = z.map((_, k) => k).filter((k) => a[k] > 0),
    ends = (wanted) => [wanted(edges[0]), ...touching.map((k) => [a[k], z[k]]), wanted(edges[edges.length - 1])],
    front = ends((edge) => [0, edge]),
    outline = [...front, ...front.map(([x, y]) => [-x, y]).reverse()];
  const data = [
    {
      type: "heatmap",
      x: columns,
      y: rows,
      z: values,
      ...aboveScale(key, low, high, fit ? most(values.map((line) => line.map((v) => v ?? low))) : high),
      colorbar: {
        thickness: 12,
        ...places.bar,
        ...(key === "state" ? { tickvals: [1, 2], ticktext: ["sticks", "slips"] } : { title: { text: unit } }),
      },
      hovertemplate: `x %{x:.3~g} mm, z %{y:.3~g} mm${key === "state" ? "" : `: %{z:.4~g} ${unit}`}<extra></extra>`,
    },
    {
      type: "scatter",
      mode: "lines",
      name: "outline",
      x: outline.map(([x]) => x),
      y: outline.map(([, y]) => y),
      hoverinfo: "skip",
      line: { color: colour("--soft"), width: 1.5, shape: "spline" },
    },
  ];
  if (lines.adheres && !lines.grid.quantities.state)
    data.push({
      type: "scatter",
      mode: "lines+markers",
      name: "end of stick, from the leading edge",
      x: touching.map((k) => side * (a[k] - row("adheres")[k])),
      y: touching.map((k) => z[k]),
      hovertemplate: "x %{x:.3~g} mm, z %{y:.3~g} mm<extra></extra>",
      line: { color: colour("--slip"), width: 3 },
    });
  // Arrows from the middle of each line, the longest of the run as long as the patch.
  const arrows = (name, pair, unit, c) => {
    const longest = Math.max(...pair[0].flatMap((along, k) => along.map((v, i) => Math.hypot(v, pair[1][k][i])))) || 1,
      [along, across] = pair.map((rows) => rows[frame]),
      tip = (part) => (reach * part) / longest;
    return {
      type: "scatter",
      mode: "lines+markers",
      name,
      x: z.flatMap((_, k) => [0, tip(along[k]), null]),
      y: z.flatMap((at, k) => [at, at + tip(across[k]), null]),
      text: z.flatMap((_, k) => ["", `${Math.hypot(along[k], across[k]).toPrecision(3)} ${unit}`, ""]),
      hovertemplate: `${name} %{text}<extra></extra>`,
      line: { color: colour(c), width: 1.5 },
      marker: { color: colour(c), symbol: "arrow", angleref: "previous", size: z.flatMap(() => [0, 9, 0]) },
    };
  };
  for (const [key, name, c] of [
    ["shear", "mean shear on the wheel", "--stick"],
    ["slip", "mean slip of the tread", "--slip"],
  ])
    if (lines[key]) data.push(arrows(name, lines[key], lines.units[key], c));
  const bodies = [
    ["temperature_wheel", "hottest place of the wheel", "--c1", "solid"],
    ["temperature_rail", "hottest place of the rail", "--c0", "dash"],
  ].filter(([key]) => lines[key]);
  for (const [key, name, c, dash] of bodies)
    data.push({
      type: "scatter",
      mode: "lines+markers",
      name,
      x: row(key),
      y: z,
      xaxis: "x2",
      ...(places.heat.y && { yaxis: "y2" }),
      hovertemplate: "z %{y:.3~g} mm: %{x:.4~g} °C<extra></extra>",
      line: { color: colour(c), width: 2, dash },
    });
  const heat = {};
  if (bodies.length) {
    const range = fit ? {} : { range: extent(...bodies.map(([key]) => lines[key])) };
    heat.xaxis2 = axis("[°C]", { domain: places.heat.x, ...(places.heat.y && { anchor: "y2" }), ...range });
    if (places.heat.y) heat.yaxis2 = axis("z [mm]", { domain: places.heat.y, range: [-across, across], anchor: "x2" });
  }
  return {
    data,
    layout: layout({
      hovermode: "closest",
      xaxis: axis("x [mm], travel to the right →", { domain: places.x, range: [-reach, reach], constrain: "domain" }),
      yaxis: axis("z [mm], across the rail", { domain: places.y, range: [-across, across], scaleanchor: "x", constrain: "domain" }),
      ...heat,
    }),
  };
}

class Film {
  constructor(film) {
    this.film = film;
    this.frame = film.start;
    this.playing = false;
    this.busy = false;
    this.ranges = {
      stress: extent(
        film.pressure,
        film.shear,
        film.limit,
        film.limit && film.shear ? film.limit.map((row) => row.map((v) => -v)) : [],
      ),
      slip: extent(film.slip),
      temperature: extent(film.temperature_wheel, film.temperature_rail),
    };
    this.grid = film.x ? film.x[0] : null;
  }

  time() {
    return this.film.time[this.frame];
  }

  x(frame) {
    return this.film.x[Math.min(frame, this.film.x.length - 1)];
  }

  // Stretches of one state: [state, from, to], which meet half way between the places.
  stretches() {
    const x = this.x(this.frame),
      state = this.film.state[this.frame],
      found = [];
    for (let k = 0; k < x.length; k++) {
      const from = k ? 0.5 * (x[k - 1] + x[k]) : x[k],
        to = k < x.length - 1 ? 0.5 * (x[k] + x[k + 1]) : x[k];
      const last = found[found.length - 1];
      if (last && last[0] === state[k]) last[2] = to;
      else found.push([state[k], from, to]);
    }
    return found.filter(([s]) => s === STICKS || s === SLIPS);
  }

  // Shear where the surfaces are in a state, to the next place beyond so that lines meet.
  part(wanted) {
    const state = this.film.state[this.frame],
      near = (k) => state[k - 1] === wanted || state[k + 1] === wanted;
    const joins = (k) => (wanted === SLIPS ? near(k) : state[k] === 0 && near(k));
    return this.film.shear[this.frame].map((v, k) => (state[k] === wanted || joins(k) ? v : null));
  }

  traces() {
    const f = this.film,
      i = this.frame,
      x = this.x(i),
      unit = f.units,
      found = [];
    const line = (name, y, c, more = {}) =>
      found.push({
        type: "scatter",
        mode: "lines",
        name,
        x,
        y,
        hovertemplate: "%{y:.4~g}",
        line: { color: colour(c), width: 2, ...more.line },
        ...more.rest,
      });
    line(`pressure`, f.pressure[i], "--c5", { rest: { fill: "tozeroy", fillcolor: faint("--c5", 0.15) } });
    if (f.limit && f.shear) {
      const dash = { width: 1.3, dash: "dot" },
        group = { legendgroup: "limit" };
      line("friction limit ±μp", f.limit[i], "--soft", { line: dash, rest: group });
      line(
        "friction limit −μp",
        f.limit[i].map((v) => -v),
        "--soft",
        { line: dash, rest: { ...group, showlegend: false } },
      );
    }
    if (f.shear && f.state.some((row) => row.includes(3))) line("shear on the wheel", f.shear[i], "--c1");
    else if (f.shear) {
      line("shear on the wheel, sticking", this.part(STICKS), "--stick", { line: { width: 3 } });
      line("shear, slipping", this.part(SLIPS), "--slip", { line: { width: 3 } });
    }
    if (f.slip) line("slip", f.slip[i], "--slip", { rest: { yaxis: "y2", showlegend: false } });
    if (f.temperature_wheel) line("temperature of the wheel", f.temperature_wheel[i], "--c1", { rest: { yaxis: "y3" } });
    if (f.temperature_rail)
      line("temperature of the rail", f.temperature_rail[i], "--c0", { line: { dash: "dash" }, rest: { yaxis: "y3" } });
    return found;
  }

  figure() {
    const f = this.film,
      fit = $("#follow").checked,
      range = (key) => (fit ? { autorange: true } : { range: this.ranges[key], autorange: false });
    const rows = [["yaxis", `stress [${f.units.pressure}]`, "stress"]];
    if (f.slip) rows.push(["yaxis2", `slip [${f.units.slip}]`, "slip"]);
    if (f.temperature_wheel || f.temperature_rail) rows.push(["yaxis3", "[°C]", "temperature"]);
    const share = {
        1: [[0, 1]],
        2: [
          [0.42, 1],
          [0, 0.36],
        ],
        3: [
          [0.52, 1],
          [0.28, 0.47],
          [0, 0.23],
        ],
      }[rows.length],
      axes = {};
    rows.forEach(([key, title, scale], k) => {
      axes[key] = axis(title, { domain: share[k], ...range(scale) });
    });
    const last = rows[rows.length - 1][0].replace("axis", "");
    const shapes = this.stretches().map(([state, x0, x1]) => ({
      type: "rect",
      x0,
      x1,
      y0: 0,
      y1: 1,
      yref: "paper",
      layer: "below",
      line: { width: 0 },
      fillcolor: faint(state === SLIPS ? "--slip" : "--stick", 0.1),
    }));
    return {
      data: this.traces(),
      layout: layout({
        ...axes,
        shapes,
        xaxis: axis("x [mm], travel to the right →", { anchor: last, range: [this.grid[0], this.grid[this.grid.length - 1]] }),
      }),
    };
  }

  map() {
    const f = this.film,
      key = $("#quantity").value,
      state = key === "state";
    const rows = f[key].map((row, k) => (f.x.length > 1 && !state ? resampled(f.x[k], row, this.grid) : row));
    const z = this.grid.map((_, node) => rows.map((row) => row[node]));
    const signed = key === "shear" || key === "slip",
      most = Math.max(...extent(rows).map(Math.abs));
    const steps = ["--card", "--stick", "--slip"].map((name) => colour(name));
    const scale = state
      ? {
          colorscale: steps.flatMap((c, k) => [
            [k / 3, c],
            [(k + 1) / 3, c],
          ]),
          zmin: -0.5,
          zmax: 2.5,
          zsmooth: false,
        }
      : signed
        ? { colorscale: "RdBu", zmin: -most, zmax: most }
        : { colorscale: key.startsWith("temp") ? INFERNO : "Viridis" };
    const bar = state ? { tickvals: [0, 1, 2], ticktext: ["apart", "sticks", "slips"] } : { title: { text: f.units[key] } };
    const hover = state
      ? "%{x:.4~g} s, %{y:.3~g} mm<extra></extra>"
      : `%{x:.4~g} s, %{y:.3~g} mm: %{z:.4~g} ${f.units[key]}<extra></extra>`;
    const data = [
      { type: "heatmap", x: f.time, y: this.grid, z, ...scale, colorbar: { thickness: 12, ...bar }, hovertemplate: hover },
    ];
    const look = { xaxis: axis("time [s]", f.window ? { range: f.window } : {}), yaxis: axis("x [mm]"), hovermode: "closest", shapes: [cursor(this.time())] };
    return { data, layout: layout(look) };
  }

  async draw() {
    const f = this.film,
      slider = $("#slider");
    slider.max = f.time.length - 1;
    if (f.pressure) await this.drawAlong();
    if (f.lines) {
      this.grids = unpackedGrid(f.lines.grid);
      for (const key of Object.keys(this.grids)) $("#seen").add(new Option(TITLES[key], key));
      await draw($("#above"), () => this.above(), false);
      $("#seen").addEventListener("change", () => {
        const { data, layout: look } = this.above();
        Plotly.react($("#above"), data, look, CONFIG);
      });
    }
    slider.addEventListener("input", () => {
      this.stop();
      this.show(Number(slider.value));
    });
    $("#play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    $("#follow").addEventListener("change", () => this.show(this.frame));
    this.tell();
  }

  above() {
    return patchFromAbove(this.film.lines, this.grids, $("#seen").value, this.frame, $("#follow").checked);
  }

  async drawAlong() {
    const f = this.film;
    for (const [key, title] of Object.entries(TITLES))
      if (f[key] && !(key === "state" && f.state.some((row) => row.includes(3)))) $("#quantity").add(new Option(title, key));
    await draw($("#film"), () => this.figure(), false);
    await draw($("#map"), () => this.map(), true);
    $("#quantity").addEventListener("change", () => {
      const { data, layout: look } = this.map();
      Plotly.react($("#map"), data, look, CONFIG);
    });
  }

  // A click on a curve or on the map moves the film there.
  link(figures) {
    for (const { div, linked } of figures)
      if (linked)
        div.on("plotly_click", (event) => {
          this.stop();
          this.show(this.at(event.points[0].x));
        });
  }

  // The frame nearest to a time.
  at(time) {
    const times = this.film.time;
    let low = 0,
      high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] > time) high = middle;
      else low = middle;
    }
    return time - times[low] < times[high] - time ? low : high;
  }

  tell() {
    $("#slider").value = this.frame;
    $("#clock").textContent = `${this.time().toFixed(3)} s`;
    const cells = this.film.readings.map(([label, unit, values]) => {
      const cell = document.createElement("span"),
        value = document.createElement("b");
      value.textContent =
        values[this.frame] === null ? "–" : Number(values[this.frame].toPrecision(4)).toString().replace("-", "−");
      cell.append(`${label} `, value, ` ${unit}`);
      return cell;
    });
    $(".readings").replaceChildren(...cells);
  }

  // Shows a frame; figures out of sight keep their cursor until they are seen again.
  async show(frame) {
    this.frame = Math.max(0, Math.min(frame, this.film.time.length - 1));
    this.tell();
    if (this.busy) return;
    this.busy = true;
    let shown = -1,
      all = false;
    while (shown !== this.frame || all === this.playing) {
      shown = this.frame;
      all = !this.playing;
      const time = this.time(),
        seen = ({ div }) => {
          const box = div.getBoundingClientRect();
          return box.bottom > 0 && box.top < innerHeight;
        };
      for (const [place, figure] of [
        ["#film", this.film.pressure && (() => this.figure())],
        ["#above", this.film.lines && (() => this.above())],
      ])
        if (figure) {
          const { data, layout: look } = figure();
          await Plotly.react($(place), data, look, CONFIG);
        }
      const moved = drawn.filter((f) => f.linked && (all || seen(f)));
      await Promise.all(moved.map(({ div }) => Plotly.relayout(div, { "shapes[0].x0": time, "shapes[0].x1": time })));
      await new Promise(requestAnimationFrame);
    }
    this.busy = false;
  }

  // Frame after frame at one pace: what was recorded more densely is seen more slowly.
  play() {
    const last = this.film.time.length - 1;
    if (this.frame >= last) this.frame = 0;
    let now = this.frame,
      before = performance.now();
    this.playing = true;
    $("#play").textContent = "❚❚ pause";
    $("#play").setAttribute("aria-pressed", "true");
    const tick = (clock) => {
      if (!this.playing) return;
      now += (((clock - before) / 1000) * last) / Number($("#pace").value);
      before = clock;
      this.show(Math.floor(now));
      if (now >= last) this.stop();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame((clock) => {
      before = clock;
      tick(clock);
    });
  }

  stop() {
    if (!this.playing) return;
    this.playing = false;
    $("#play").textContent = "▶ play";
    $("#play").setAttribute("aria-pressed", "false");
    this.show(this.frame);
  }
}
