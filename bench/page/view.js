// What is shown of a frame: readings, maps, curves, energies.
"use strict";

const $ = (selector) => document.querySelector(selector);
const KELVIN = 273.15;

// A frame by name, from the row of numbers and its description.
class Frame {
  constructor(numbers, description) {
    const { columns, status, stretches, conditions, map, depth } = description;
    let at = 0;
    const take = (n) => numbers.subarray(at, (at += n));
    this.values = {};
    for (const name of columns) this.values[name] = numbers[at++];
    for (const name of status) this.values[name] = numbers[at++];
    const pairs = take(2 * stretches);
    this.stretches = Array.from({ length: this.values.stretches }, (_, k) => ({
      begin: pairs[2 * k],
      condition: conditions[pairs[2 * k + 1]],
    }));
    this.map = { ...map };
    for (const name of map.quantities) this.map[name] = take(map.along * map.across);
    for (const name of map.outline) this.map[name] = take(map.across);
    this.depth = {};
    for (const name of depth.quantities) this.depth[name] = take(depth.points);
  }

  get(name) {
    return this.values[name];
  }
}

// Readings: label, unit, digits, value of a frame.
const TILES = [
  ["time", "s", 3, (f) => f.get("time"), 3],
  ["speed", "km/h", 1, (f) => 3.6 * f.get("wheel.velocity")],
  ["creepage", "%", 2, (f) => 100 * f.get("contact.creepage")],
  ["brake force", "kN", 2, (f) => -1e-3 * f.get("contact.force_x")],
  ["lateral force, right", "kN", 2, (f) => 1e-3 * f.get("contact.force_z")],
  ["friction in use", "%", 0, (f) => 100 * f.get("contact.utilisation")],
  ["part that sticks", "%", 0, (f) => 100 * f.get("contact.stick_fraction")],
  ["friction power", "kW", 2, (f) => 1e-3 * f.get("heat.friction_power")],
  ["largest pressure", "MPa", 0, (f) => 1e-6 * f.get("contact.pressure_max")],
  ["hottest place", "°C", 0, (f) => Math.max(f.get("temperature.wheel_max"), f.get("temperature.rail_max")) - KELVIN],
];

// Stick and slip, beyond the patch that of its nearest place in the row: colours run on to the outline.
function spread({ along, across, state }) {
  const found = state.slice();
  for (let row = 0; row < across; row++) {
    const first = row * along;
    for (let k = first + 1; k < first + along; k++) if (!found[k]) found[k] = found[k - 1];
    for (let k = first + along - 2; k >= first; k--) if (!found[k]) found[k] = found[k + 1];
    if (!found[first]) found.fill(1, first, first + along);
  }
  return found;
}

class View {
  constructor() {
    this.maps = Object.fromEntries(["pressure", "shear", "temperature"].map((n) => [n, new PatchPicture($(`#map-${n}`))]));
    const chart = (id, options) => new Chart($(`#${id}`), options);
    this.along = chart("along", { x: "x [mm]", y: "MPa", zero: true });
    this.below = chart("depth", { x: "°C", y: "mm", down: true });
    this.speed = chart("chart-speed", { x: "s", y: "km/h", zero: true });
    this.creepage = chart("chart-creepage", { x: "s", y: "%", zero: true });
    this.force = chart("chart-force", { x: "s", y: "kN", zero: true });
    this.hot = chart("chart-temperature", { x: "s", y: "°C" });
    this.memory = new Memory(5);
    this.cells = TILES.map(([label, unit]) => {
      const box = document.createElement("div"),
        name = document.createElement("dt"),
        value = document.createElement("dd");
      name.textContent = label;
      box.append(name, value);
      $("#tiles").append(box);
      return { value, unit };
    });
    this.most = {};
  }

  // Forgets what was seen of another run.
  clear() {
    this.memory.clear();
    this.most = {};
  }

  note(frame) {
    const v = frame.values;
    this.memory.add(v.time, {
      travel: 3.6 * v["wheel.velocity"],
      tread: 3.6 * (v["wheel.velocity"] - v["contact.slip_velocity"]),
      creepage: 100 * v["contact.creepage"],
      force: -1e-3 * v["contact.force_x"],
      limit: 1e-3 * v["contact.friction"] * v["contact.force_y"],
      wheel: v["temperature.wheel_max"] - KELVIN,
      rail: v["temperature.rail_max"] - KELVIN,
    });
  }

  // The largest value of a run so far: ends of colours do not jump up and down.
  largest(name, values) {
    for (const v of values) if (Number.isFinite(v)) this.most[name] = Math.max(this.most[name] ?? -Infinity, v);
    return this.most[name];
  }

  show(frame) {
    this.frame = frame;
    TILES.forEach(([, unit, digits, value], k) => {
      const text = value(frame).toFixed(digits);
      this.cells[k].value.textContent = `${(Number(text) === 0 ? (0).toFixed(digits) : text).replace("-", "−")} ${unit}`;
    });
    drawRail($("#track"), frame.stretches, frame.get("angle"));
    this.showMaps(frame);
    this.showCurves(frame);
    this.showEnergy(frame);
  }

  showMaps({ map, values }) {
    const { along, across } = map,
      x = [1e3 * values.x_low, 1e3 * values.x_high],
      z = [1e3 * values.z_low, 1e3 * values.z_high],
      outline = across > 1 ? this.outline(map, z) : [],
      step = (share) => Math.max(0, Math.min(255, Math.round(255 * share))),
      some = (colours) => colours.filter((_, k) => k % 8 === 0),
      pressure = 1e-6 * this.largest("pressure", map.pressure) || 1,
      shears = map.shear.map((along, k) => Math.hypot(along, map.shear_z[k])),
      shear = 1e-6 * this.largest("shear", shears) || 1,
      clear = [0, 0, 0, 0],
      inside = (k) => across > 1 || map.state[k];
    const { pressure: ofPressure, shear: ofShear, temperature: ofHeat } = this.maps;
    ofPressure.paint(along, across, (k) => (inside(k) ? PALETTES.viridis[step((1e-6 * map.pressure[k]) / pressure)] : clear));
    ofPressure.draw({ x, z, outline, legend: (g, a, b, h) => bar(g, a, b, h, [some(PALETTES.viridis)], 0, pressure, "MPa") });
    const tint = this.tints(),
      state = spread(map);
    ofShear.paint(along, across, (k) => (inside(k) ? tint[state[k]][step((1e-6 * shears[k]) / shear)] : clear));
    ofShear.draw({ x, z, outline, legend: (g, a, b, h) => bar(g, a, b, h, [some(tint[1]), some(tint[2])], 0, shear, "MPa") });
    const body = $("#body").value,
      heat = map[body],
      low = Math.min(...heat) - KELVIN,
      high = Math.max(this.largest(body, heat) - KELVIN, low + 10);
    ofHeat.paint(along, across, (k) => PALETTES.inferno[step((heat[k] - KELVIN - low) / (high - low))]);
    ofHeat.draw({ x, z, outline: [], legend: (g, a, b, h) => bar(g, a, b, h, [some(PALETTES.inferno)], low, high, "°C") });
  }

  // Polygons around the patch [mm], one for each of its parts.
  outline({ across, rear, front }, z) {
    const half = (z[1] - z[0]) / across / 2,
      height = (row) => z[0] + (2 * row + 1) * half,
      found = [];
    let part = null;
    for (let row = 0; row <= across; row++) {
      const touches = row < across && front[row] > rear[row],
        last = row - 1;
      if (touches && !part) found.push((part = [[500 * (rear[row] + front[row]), height(row) - half]]));
      if (touches) {
        part.push([1e3 * front[row], height(row)]);
        part.unshift([1e3 * rear[row], height(row)]);
      } else if (part) {
        part.push([500 * (rear[last] + front[last]), height(last) + half]);
        part = null;
      }
    }
    return found;
  }

  // Shades of stick and slip, made anew when the theme changes.
  tints() {
    const key = css("--stick") + css("--slip") + css("--card");
    if (this.tintKey !== key) {
      this.tintKey = key;
      this.tint = { 1: palette([css("--stick-pale"), css("--stick")]), 2: palette([css("--slip-pale"), css("--slip")]) };
    }
    return this.tint;
  }

  showCurves({ map, depth, values }) {
    const { along, across } = map,
      first = along * Math.floor(across / 2),
      row = (name, factor) => Array.from(map[name].subarray(first, first + along), (v) => factor * v),
      x = Array.from({ length: along }, (_, k) => 1e3 * (values.x_low + ((values.x_high - values.x_low) * (k + 0.5)) / along)),
      pressure = row("pressure", 1e-6),
      limit = pressure.map((p) => p * values["contact.friction"]),
      aside = row("shear_z", 1e-6),
      // Of a wheel that slides to the side, too, the amount.
      shear = row("shear", 1e-6).map((v, k) => Math.sign(v) * Math.hypot(v, aside[k])),
      part = (state) => shear.map((v, k) => (map.state[first + k] === state ? v : NaN)),
      sign = values["contact.force_x"] > 0 ? 1 : -1;
    this.along.draw(
      [
        { name: "pressure", colour: "--soft", x, y: pressure, width: 1.5 },
        { name: "friction × pressure", colour: "--limit", x, y: limit.map((v) => sign * v), dash: [3, 3], width: 1.5 },
        { name: "shear, sticks", colour: "--stick", x, y: part(1), width: 3 },
        { name: "slips", colour: "--slip", x, y: part(2), width: 3 },
      ],
      { xRange: [1e3 * values.x_low, 1e3 * values.x_high] },
    );
    const deep = Array.from(depth.depth, (d) => 1e3 * d),
      celsius = (name) => Array.from(depth[name], (t) => t - KELVIN),
      hot = [...celsius("wheel"), ...celsius("rail")];
    const top = Math.max(this.largest("below", hot), Math.min(...hot) + 10);
    this.below.draw(
      [
        { name: "wheel", colour: "--wheel", x: celsius("wheel"), y: deep },
        { name: "rail", colour: "--railc", x: celsius("rail"), y: deep },
      ],
      { yRange: [0, 5], xRange: [Math.min(...hot) - 2, top] },
    );
    const m = this.memory,
      xRange = m.range();
    this.speed.draw([m.curve("travel", "vehicle", "--railc"), m.curve("tread", "tread of the wheel", "--wheel")], { xRange });
    this.creepage.draw([m.curve("creepage", "", "--wheel")], { xRange });
    this.force.draw([m.curve("limit", "limit of friction", "--soft", { dash: [3, 3] }), m.curve("force", "force", "--wheel")], { xRange });
    this.hot.draw([m.curve("wheel", "wheel", "--wheel"), m.curve("rail", "rail", "--railc")], { xRange });
  }

  showEnergy({ values: v }) {
    const e = (name) => 1e-3 * v[`energy.${name}`],
      given = [
        ["given by the motion", -e("stored"), "motion"],
        ["given by what guides the wheel and holds its speed", e("hub_work") + e("brake") + e("gravity") + e("rail_work"), "motion"],
        ["given by heat, which swells the steel", e("thermal_work"), "motion"],
      ],
      taken = [
        ["taken by the brake", e("brake"), "brake"],
        ["friction in the patch, into heat", e("friction"), "friction"],
        ["damping, of the steel and into the rail", e("damping"), "none"],
        ["flattening of the steel", e("plastic"), "none"],
      ],
      sum = (rows) => rows.reduce((total, [, value]) => total + value, 0),
      all = Math.max(...[...given, ...taken].map(([, value]) => Math.abs(value)), 1e-3),
      // What has given next to nothing has no row, but counts.
      rows = [...given.filter(([, value], k) => k === 0 || Math.abs(value) > 1e-2 * all), ...taken];
    rows.push(["unaccounted for", sum(given) - sum(taken), "none"]);
    const most = Math.max(...rows.map(([, value]) => Math.abs(value)), 1e-3);
    if ($("#energy").rows.length !== rows.length)
      $("#energy").replaceChildren(
        ...rows.map(() => {
          const row = document.createElement("tr");
          row.innerHTML = "<th scope=row></th><td></td><td class=track><i></i></td>";
          return row;
        }),
      );
    rows.forEach(([label, value, kind], k) => {
      const [name, number, track] = $("#energy").rows[k].cells;
      name.textContent = label;
      // Below 1 kJ in joules: what damps is a ten-thousandth of what brakes.
      number.textContent = Math.abs(value) < 5e-4 ? "0 J" : Math.abs(value) < 1 ? `${shown(1e3 * value)} J` : `${shown(value)} kJ`;
      track.firstChild.className = kind;
      track.firstChild.style.width = `${(100 * Math.abs(value)) / most}%`;
    });
  }
}
