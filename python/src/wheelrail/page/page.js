"use strict";
// Unpacks the library and the data, draws the curves, links their time axes, follows the colours of the window.

const $ = (selector) => document.querySelector(selector);
const drawn = []; // every figure: { div, build(): {data, layout}, linked: whether x is time }

async function unpacked(id) {
  const bytes = Uint8Array.from(atob($(id).textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).text();
}

function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function curveColour(k) {
  return k < 0 ? colour("--text") : colour(`--c${k % 8}`);
}

function faint(name, alpha) {
  const hex = colour(name).slice(1);
  return `rgba(${[0, 2, 4].map((k) => parseInt(hex.slice(k, k + 2), 16)).join(",")},${alpha})`;
}

function axis(title, more = {}) {
  const line = colour("--line");
  return {
    title: { text: title, standoff: 6 },
    gridcolor: colour("--grid"),
    zerolinecolor: line,
    linecolor: line,
    automargin: true,
    ...more,
  };
}

function layout(more) {
  return {
    paper_bgcolor: "rgba(0,0,0,0)",
    plot_bgcolor: "rgba(0,0,0,0)",
    uirevision: "kept",
    hovermode: "x unified",
    separators: ".\u2009",
    font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: colour("--text") },
    hoverlabel: { bgcolor: colour("--card"), bordercolor: colour("--line"), font: { color: colour("--text") } },
    modebar: { bgcolor: "rgba(0,0,0,0)", color: colour("--soft"), activecolor: colour("--text") },
    margin: { l: 10, r: 12, t: 8, b: 10 },
    legend: { orientation: "h", y: 1.02, yanchor: "bottom", x: 0 },
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
    ...more,
  };
}

// Black over violet and orange to pale yellow (the scale "inferno" of matplotlib).
const INFERNO = [
  "#000004",
  "#160b39",
  "#420a68",
  "#6a176e",
  "#932667",
  "#bc3754",
  "#dd513a",
  "#f37819",
  "#fca50a",
  "#f6d746",
  "#fcffa4",
].map((c, k) => [k / 10, c]);

const CONFIG = {
  responsive: true,
  displaylogo: false,
  // No others: one of plotly's own shares the figure on its server.
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "resetScale2d"]],
  plotlyServerURL: "",
  toImageButtonOptions: { scale: 2 },
};

async function draw(div, build, linked) {
  const figure = { div, build, linked };
  const { data, layout: look } = build();
  await Plotly.newPlot(div, data, look, CONFIG);
  drawn.push(figure);
  if (linked) div.on("plotly_relayout", (change) => follow(figure, change));
  return figure;
}

let following = false;
async function follow(source, change) {
  const start = change["xaxis.range[0]"],
    end = change["xaxis.range[1]"];
  if (following || (start === undefined && !change["xaxis.autorange"])) return;
  following = true;
  const update = start === undefined ? { "xaxis.autorange": true } : { "xaxis.range[0]": start, "xaxis.range[1]": end };
  await Promise.all(drawn.filter((f) => f.linked && f !== source).map((f) => Plotly.relayout(f.div, update)));
  following = false;
}

async function redraw() {
  const printing = document.documentElement.classList.contains("printing");
  await Promise.all(
    drawn.map(({ div, build }) => {
      const { data, layout: look } = build();
      if (printing) Object.assign(look, { width: div.clientWidth, height: div.clientHeight, font: { ...look.font, size: 10 } });
      return Plotly.react(div, data, look, CONFIG);
    }),
  );
}

// Paper is white and as wide as paper, whatever the window is.
function print(now) {
  document.documentElement.classList.toggle("printing", now);
  redraw();
}

function cursor(time) {
  return {
    type: "line",
    x0: time,
    x1: time,
    y0: 0,
    y1: 1,
    yref: "paper",
    line: { color: colour("--soft"), width: 1, dash: "dot" },
  };
}

function curves(chart, time, range) {
  const data = chart.traces.map((t) => ({
    type: "scatter",
    mode: "lines",
    name: t.name,
    x: t.x,
    y: t.y,
    connectgaps: false,
    visible: t.hidden ? "legendonly" : true,
    line: { color: curveColour(t.colour), width: 1.6, dash: t.dash || "solid" },
    hovertemplate: `%{y:.4~g} ${chart.unit}`,
  }));
  const y = axis(chart.unit ? `[${chart.unit}]` : "[1]", { exponentformat: "power", ...(range ? { range } : {}) });
  return {
    data,
    layout: layout({ xaxis: axis(chart.x), yaxis: y, showlegend: true, shapes: time === null ? [] : [cursor(time)] }),
  };
}

function place(parent, title, note) {
  const card = document.createElement("figure"),
    head = document.createElement("h3"),
    div = document.createElement("div");
  card.style.margin = "0";
  head.textContent = title;
  div.className = "plot";
  div.setAttribute("role", "img");
  div.setAttribute("aria-label", title);
  card.append(head, div);
  if (note) {
    const words = document.createElement("p");
    words.className = "note";
    words.textContent = note;
    card.append(words);
  }
  parent.append(card);
  return div;
}

// Places for figures, all of them before the first is drawn: they share the width.
function placed(charts, parent) {
  return charts.map((chart) => [chart, place($(chart.room ? `#${chart.room}` : parent), chart.title, chart.note)]);
}

// The same range of y for a figure of all stops, so that they compare; none if a stop would be a flat line in it.
function common(views, title) {
  const charts = Object.values(views).flatMap((all) => all.filter((c) => c.title === title)),
    spans = charts.map(span);
  const low = Math.min(...spans.map(([a]) => a)),
    high = Math.max(...spans.map(([, b]) => b)),
    room = 0.05 * (high - low) || 1;
  return spans.every(([a, b]) => b - a > 0.1 * (high - low)) ? [low - room, high + room] : null;
}

function span(chart) {
  const values = chart.traces.flatMap((t) => t.y).filter((v) => v !== null);
  return [values.reduce((a, b) => Math.min(a, b), Infinity), values.reduce((a, b) => Math.max(a, b), -Infinity)];
}

async function drawViews(views, film) {
  const names = Object.keys(views),
    several = names.length > 1;
  let name = several ? $("input[name=view]:checked").value : names[0];
  const all = Object.values(views).flat(),
    first = all.filter((c, k) => all.findIndex((other) => other.title === c.title) === k);
  for (const [{ title }, div] of placed(first, "#charts")) {
    const range = several ? common(views, title) : null,
      none = { title, unit: "", traces: [], x: "time [s]" };
    await draw(div, () => curves(views[name].find((c) => c.title === title) || none, film ? film.time() : null, range), true);
  }
  document.querySelectorAll("input[name=view]").forEach((button) =>
    button.addEventListener("change", () => {
      name = button.value;
      redraw();
    }),
  );
}

async function drawMore(charts, film) {
  for (const [chart, div] of placed(charts, "#more")) {
    const figure = await draw(div, () => curves(chart, film ? film.time() : null), true);
    if (film) film.link([figure]);
  }
}

async function start() {
  if (typeof DecompressionStream === "undefined") throw new Error("this browser is too old to unpack the figures");
  const script = document.createElement("script");
  script.textContent = await unpacked("#library");
  document.head.append(script);
  const data = JSON.parse(await unpacked("#data"));
  const film = data.film ? new Film(data.film) : null;
  if (film) await film.draw();
  for (const [field, div] of placed(data.fields, "#fields"))
    await draw(div, () => depthMap(field, film ? film.time() : null), true);
  for (const [chart, div] of placed(data.overview, "#together")) await draw(div, () => curves(chart, null), false);
  await drawViews(data.views, film);
  if (data.more.length) $("#more").closest("details").addEventListener("toggle", () => drawMore(data.more, film), { once: true });
  if (film) film.link(drawn);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  addEventListener("beforeprint", () => print(true));
  addEventListener("afterprint", () => print(false));
  document.body.dataset.ready = "yes";
}

addEventListener("DOMContentLoaded", () =>
  start().catch((error) => {
    $("#trouble").hidden = false;
    $("#trouble").textContent = `The figures cannot be drawn: ${error.message}`;
    throw error;
  }),
);
