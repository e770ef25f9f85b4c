// The bench: controls, the clock of the run, what can be taken along. The core runs in a worker (worker.js).
"use strict";

const STEP = 1e-3,
  // Computing time for one picture [ms]: a slower machine falls behind the clock and stays at hand.
  BUDGET = 28;

// Requests to the worker, each answered once.
class Core {
  constructor(text) {
    this.worker = new Worker(URL.createObjectURL(new Blob([text], { type: "text/javascript" })));
    this.waiting = new Map();
    this.number = 0;
    this.worker.onmessage = ({ data: { id, answer, error } }) => {
      const { resolve, reject } = this.waiting.get(id);
      this.waiting.delete(id);
      if (error === undefined) resolve(answer);
      else reject(new Error(error));
    };
  }

  ask(kind, request = {}) {
    return new Promise((resolve, reject) => {
      this.waiting.set(++this.number, { resolve, reject });
      this.worker.postMessage({ id: this.number, kind, ...request });
    });
  }
}

// A script beside the page; from a file nothing else can be read.
function script(source) {
  return new Promise((resolve, reject) => {
    const element = document.createElement("script");
    element.src = source;
    element.onload = resolve;
    element.onerror = () => reject(new Error(`${source} cannot be read`));
    document.head.append(element);
  });
}

class Bench {
  constructor() {
    this.core = new Core(BENCH_CORE.worker);
    this.view = new View();
    this.running = false;
    this.begun = false;
    this.held = new Set();
    this.rail = "dry";
    this.starts = Promise.resolve();
    // Torque and load of the last frame.
    this.set = {};
    // The link that was opened, if it has changes over time.
    this.script = null;
    this.measure();
  }

  async load() {
    await this.core.ask("load", { wasm: BENCH_CORE.wasm });
    const given = location.hash.slice(1);
    try {
      await this.start(given || this.wished());
    } catch (error) {
      this.say(error.message, true);
      await this.start(this.wished(), true);
    }
    $("#version").textContent = `wheelrail ${BENCH_CORE.version}`;
    for (const button of document.querySelectorAll("button:disabled")) button.disabled = false;
    document.documentElement.dataset.ready = "yes";
  }

  // The link of what the controls say.
  wished() {
    const value = (name) => $(`#${name}`).value,
      patch = $("input[name=patch]:checked").value,
      angle = patch === "line" || value("angle") === "0" ? "" : `&angle=${value("angle")}`;
    return `patch=${patch}&rail=${this.rail}&speed=${value("speed")}&load=${value("load")}&torque=${value("torque")}${angle}`;
  }

  // Starts a run in the place of the one before. What a link does not say is held as the page says.
  async start(link, quiet = false) {
    const scripted = /(^|&|%26)at(=|%3d)/i.test(link),
      hold = $("#hold").checked && !scripted;
    this.stop();
    const { name } = await this.core.ask("basis", { link });
    if (!this.held.has(name) && BENCH_CORE.bases.includes(name)) {
      await script(`bases/${name}.js`);
      await this.core.ask("hold", { basis: BENCH_BASES[name] });
      delete BENCH_BASES[name];
      this.held.add(name);
    }
    const { description, frame } = await this.core.ask("start", { link });
    this.description = description;
    this.begun = false;
    this.view.clear();
    this.show(link);
    this.take(frame);
    this.script = scripted ? link : null;
    if (hold) await this.change("hold");
    if (!quiet) this.say(scripted ? "This link repeats a run: press start." : "Ready. Press start, then lock the wheel.");
    $("#railhint").textContent = "at the start";
  }

  // Controls as the link of a run says.
  show(link) {
    if (!link.includes("angle=")) $("#angle").value = 0;
    for (const pair of link.split("&")) {
      const [name, value] = pair.split("=");
      if (["speed", "load", "torque", "angle"].includes(name)) $(`#${name}`).value = value;
      if (name === "patch") $(`input[name=patch][value=${value}]`).checked = true;
      if (name === "rail") this.rail = value;
    }
    this.tell();
  }

  tell() {
    // A line has no width, and no force across.
    $("#angle").disabled = $("input[name=patch]:checked").value === "line";
    for (const [name, unit] of [
      ["speed", "km/h"],
      ["torque", "kN m"],
      ["load", "kN"],
      ["angle", "mrad"],
    ])
      $(`#${name}-value`).textContent = `${$(`#${name}`).value} ${unit}`;
    for (const button of document.querySelectorAll("[data-rail]"))
      button.setAttribute("aria-pressed", String(button.dataset.rail === this.rail));
  }

  say(text, bad = false) {
    $("#message").textContent = text;
    $("#message").className = bad ? "bad" : "";
  }

  // Takes a frame; draws it unless another comes at once.
  take(numbers) {
    const frame = new Frame(numbers, this.description);
    this.view.note(frame);
    this.view.show(frame);
    const locked = frame.get("locked") === 1;
    $("#lock").setAttribute("aria-pressed", String(locked));
    $("#lock").textContent = locked ? "release the wheel" : "lock the wheel";
    $("#hold").checked = frame.get("held") === 1;
    // Sliders follow a link, and are left alone while somebody moves them.
    for (const name of ["torque", "load"]) {
      const value = 1e-3 * frame.get(`${name}_set`);
      if (value !== this.set[name]) {
        this.set[name] = value;
        $(`#${name}`).value = value;
        this.tell();
      }
    }
    const last = frame.stretches[frame.stretches.length - 1];
    if (last && last.condition !== this.rail) {
      this.rail = last.condition;
      this.tell();
    }
    this.frame = frame;
  }

  async change(change) {
    try {
      const { frame } = await this.core.ask("change", { change });
      this.take(frame);
    } catch (error) {
      this.say(error.message, true);
    }
  }

  toggle() {
    if (this.running) this.stop();
    else this.run();
  }

  stop() {
    this.running = false;
    $("#go").textContent = "▶ start";
    $("#go").setAttribute("aria-pressed", "false");
  }

  // One picture after the other, as far as the clock has gone on or the computing time reaches.
  async run() {
    this.running = this.begun = true;
    $("#go").textContent = "❚❚ pause";
    $("#go").setAttribute("aria-pressed", "true");
    $("#railhint").textContent = "from 5 m ahead on";
    this.measure();
    let before = await new Promise(requestAnimationFrame),
      owed = 0;
    while (this.running) {
      const now = await new Promise(requestAnimationFrame),
        pace = Number($("#pace").value),
        passed = Math.min(now - before, 100);
      before = now;
      owed = Math.min(owed + (pace * passed) / (1e3 * STEP), pace === Infinity ? 1e6 : 100);
      if (!this.running) break;
      if (owed >= 1) owed = await this.advance(Math.floor(owed), owed);
    }
  }

  // Does steps; returns what is left to do.
  async advance(steps, owed = steps) {
    const { done, error, spent, frame } = await this.core.ask("advance", { steps, budget: BUDGET });
    const m = this.measured;
    m.frames++;
    m.steps += done;
    m.spent += spent;
    this.take(frame);
    if (error) {
      this.stop();
      this.say(`This step was not found: ${error}. The run stands where it was; change something and go on.`, true);
    } else this.tellPace();
    return done < steps ? 0 : owed - done;
  }

  // Pictures, steps and computing time [ms] from now on.
  measure() {
    this.measured = { frames: 0, steps: 0, spent: 0, since: performance.now() };
  }

  // How fast the run is, once a second.
  tellPace() {
    const m = this.measured,
      now = performance.now();
    if (now - m.since < 1000 || m.steps === 0) return;
    this.measure();
    const speed = (1e3 * STEP * m.steps) / (now - m.since);
    this.say(`${shown(speed, 2)} × real time, ${shown(m.spent / m.steps, 2)} ms of computing a step of 1 ms, ${shown((1e3 * m.frames) / (now - m.since), 2)} pictures a second`);
  }

  // A new run as the controls say, or of a link; one after the other, as somebody may not wait.
  restart(link = this.wished()) {
    const goes = this.running;
    this.starts = this.starts.then(async () => {
      try {
        await this.start(link);
        if (goes) this.run();
      } catch (error) {
        this.say(error.message, true);
      }
    });
    return this.starts;
  }

  async layRail(condition) {
    this.rail = condition;
    this.tell();
    if (this.begun) await this.change(`rail=${condition}`);
    else await this.restart();
  }

  text(what) {
    return this.core.ask("text", { what }).then(({ text }) => text);
  }

  async share() {
    const link = await this.text("link");
    this.mine = `#${link}`;
    location.replace(this.mine);
    this.offer("Link to this run", "Whoever opens it repeats the run to its present end, step by step.", location.href);
  }

  async python() {
    const note = "They repeat the run on the FMU and print the table that the button CSV saves.";
    this.offer("The lines of Python that repeat this run", note, await this.text("python"));
  }

  offer(title, note, text) {
    $("#taken-title").textContent = title;
    $("#taken-note").textContent = note;
    $("#taken-text").value = text;
    $("#copy").textContent = "copy";
    $("#taken").showModal();
  }

  async csv() {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([await this.text("csv")], { type: "text/csv" }));
    link.download = "bench.csv";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
  }

  lock() {
    return this.change(this.frame.get("locked") ? "release" : "lock");
  }

  async copy() {
    const area = $("#taken-text");
    area.select();
    try {
      await navigator.clipboard.writeText(area.value);
    } catch {
      document.execCommand("copy");
    }
    $("#copy").textContent = "copied";
  }
}

function turn(id, by) {
  const slider = $(`#${id}`);
  slider.value = Number(slider.value) + by * Number(slider.step);
  slider.dispatchEvent(new Event("input"));
  slider.dispatchEvent(new Event("change"));
}

const KEYS = {
  " ": (bench) => bench.toggle(),
  ".": (bench) => {
    bench.stop();
    bench.begun = true;
    bench.advance(1);
  },
  l: (bench) => bench.lock(),
  r: (bench) => bench.restart(bench.script ?? undefined),
  h: () => $("#hold").click(),
  d: (bench) => bench.layRail("dry"),
  w: (bench) => bench.layRail("wet"),
  f: (bench) => bench.layRail("leaves"),
  s: () => ($("#pace").selectedIndex = ($("#pace").selectedIndex + 1) % $("#pace").length),
  "?": () => $("#help").showModal(),
  ArrowUp: () => turn("torque", 1),
  ArrowDown: () => turn("torque", -1),
};

function wire(bench) {
  const on = (selector, event, f) => $(selector).addEventListener(event, f);
  on("#go", "click", () => bench.toggle());
  on("#lock", "click", () => bench.lock());
  on("#again", "click", () => bench.restart(bench.script ?? undefined));
  on("#share", "click", () => bench.share());
  on("#csv", "click", () => bench.csv());
  on("#python", "click", () => bench.python());
  on("#keys", "click", () => $("#help").showModal());
  on("#copy", "click", () => bench.copy());
  on("#hold", "change", (event) => bench.change(event.target.checked ? "hold" : "coast"));
  on("#body", "change", () => bench.view.show(bench.frame));
  for (const radio of document.querySelectorAll("input[name=patch]")) radio.addEventListener("change", () => bench.restart());
  for (const button of document.querySelectorAll("[data-rail]")) button.addEventListener("click", () => bench.layRail(button.dataset.rail));
  for (const name of ["speed", "torque", "load", "angle"]) on(`#${name}`, "input", () => bench.tell());
  for (const name of ["speed", "angle"]) on(`#${name}`, "change", () => bench.restart());
  for (const name of ["torque", "load"])
    on(`#${name}`, "change", ({ target }) => (bench.begun ? bench.change(`${name}=${target.value}`) : bench.restart()));
  addEventListener("keydown", (event) => {
    const { key, target, ctrlKey, metaKey, altKey } = event;
    const own = target.closest("dialog, textarea, select") || (target.matches("input[type=range], input[type=radio]") && key.startsWith("Arrow"));
    const pressed = key === " " && target.matches("button, input[type=checkbox]");
    const action = KEYS[key];
    if (!action || own || pressed || ctrlKey || metaKey || altKey || !bench.frame) return;
    event.preventDefault();
    action(bench);
  });
  addEventListener("hashchange", () => {
    if (location.hash !== bench.mine) bench.restart(location.hash.slice(1));
  });
  const redraw = () => bench.frame && bench.view.show(bench.frame);
  addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    style.clear();
    redraw();
  });
}

const BENCH_BASES = {};
let bench;
if (typeof BENCH_CORE === "undefined") $("#message").textContent = "core.js is missing: make the page by `make bench-page`.";
else {
  bench = new Bench();
  wire(bench);
  bench.load().catch((error) => bench.say(error.message, true));
}
