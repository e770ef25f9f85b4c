// Curves on canvases: over time, along the patch, over the depth.
"use strict";

// Curves with axes. `upright`: the second axis goes down, as depth does.
class Chart {
  constructor(canvas, { x, y, down = false, zero = false }) {
    Object.assign(this, { canvas, x, y, down, zero });
  }

  // Curves are {name, colour, x, y, dash, fill}; `range` fixes an axis.
  draw(curves, { xRange, yRange } = {}) {
    const { g, width, height } = pen(this.canvas),
      left = 52,
      right = 12,
      top = 22,
      bottom = 32,
      [x0, x1] = xRange || extent(curves, "x", false),
      [y0, y1] = yRange || extent(curves, "y", this.zero),
      px = (v) => left + ((width - left - right) * (v - x0)) / (x1 - x0),
      py = (v) => {
        const share = (v - y0) / (y1 - y0);
        return top + (height - top - bottom) * (this.down ? share : 1 - share);
      };
    this.axes(g, { left, right, top, bottom, width, height, x0, x1, y0, y1, px, py });
    g.save();
    g.beginPath();
    g.rect(left, top, width - left - right, height - top - bottom);
    g.clip();
    for (const curve of curves) {
      const { x, y } = curve;
      g.beginPath();
      for (let k = 0, pen = false; k < x.length; k++) {
        if (!Number.isFinite(y[k])) {
          pen = false;
          continue;
        }
        if (pen) g.lineTo(px(x[k]), py(y[k]));
        else g.moveTo(px(x[k]), py(y[k]));
        pen = true;
      }
      g.strokeStyle = css(curve.colour);
      g.lineWidth = curve.width || 2;
      g.setLineDash(curve.dash || []);
      g.stroke();
      g.setLineDash([]);
    }
    g.restore();
    this.names(g, curves, left, width - right);
  }

  axes(g, { left, right, top, bottom, width, height, x0, x1, y0, y1, px, py }) {
    g.strokeStyle = css("--grid");
    g.fillStyle = css("--soft");
    g.lineWidth = 1;
    g.textBaseline = "top";
    g.textAlign = "center";
    for (const v of ticks(x0, x1, Math.max(2, (width - left - right) / 70))) {
      line(g, px(v), top, px(v), height - bottom);
      g.fillText(shown(v), px(v), height - bottom + 4);
    }
    g.textAlign = "right";
    g.textBaseline = "middle";
    for (const v of ticks(y0, y1, Math.max(2, (height - top - bottom) / 34))) {
      line(g, left, py(v), width - right, py(v));
      g.fillText(shown(v), left - 5, py(v));
    }
    g.textBaseline = "bottom";
    g.fillText(this.x, width - right, height);
    g.textAlign = "left";
    g.textBaseline = "top";
    g.fillText(this.y, 2, 2);
  }

  // Names of the curves, right of the unit.
  names(g, curves, left, end) {
    g.textBaseline = "top";
    g.textAlign = "right";
    let x = end;
    for (const { name, colour } of [...curves].reverse()) {
      if (!name) continue;
      g.fillStyle = css(colour);
      g.fillText(name, x, 2);
      x -= g.measureText(name).width + 14;
    }
  }
}

function line(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

function extent(curves, axis, zero) {
  let low = zero ? 0 : Infinity,
    high = zero ? 0 : -Infinity;
  for (const curve of curves)
    for (const v of curve[axis])
      if (Number.isFinite(v)) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
  if (!(low <= high)) return [0, 1];
  const room = axis === "x" ? 0 : 0.06 * (high - low),
    least = 1e-3 * Math.max(Math.abs(low), Math.abs(high), 1e-6);
  return high - low < least ? [low - 0.5 * least, high + 0.5 * least] : [low - (zero && low === 0 ? 0 : room), high + room];
}

// Values over time. What lies back more than `seconds` is forgotten.
class Memory {
  constructor(seconds) {
    this.seconds = seconds;
    this.clear();
  }

  clear() {
    this.time = [];
    this.values = {};
  }

  add(time, values) {
    if (this.time.length && time <= this.time[this.time.length - 1]) return;
    this.time.push(time);
    for (const [name, value] of Object.entries(values)) (this.values[name] ||= []).push(value);
    const old = this.time.findIndex((t) => t >= time - this.seconds);
    // In blocks, as each costs a copy.
    if (old > 500) {
      this.time.splice(0, old);
      for (const column of Object.values(this.values)) column.splice(0, old);
    }
  }

  range() {
    const end = this.time[this.time.length - 1] ?? 0;
    return [Math.max(0, end - this.seconds), Math.max(end, 0.02)];
  }

  curve(name, label, colour, more = {}) {
    return { name: label, colour, x: this.time, y: this.values[name] || [], ...more };
  }
}

// The rail from 3 m behind the wheel to 12 m ahead of it, and the wheel, turned by an angle.
function drawRail(canvas, stretches, angle) {
  const { g, width, height } = pen(canvas),
    [behind, ahead] = [-3, 12],
    px = (m) => (width * (m - behind)) / (ahead - behind),
    top = height - 12;
  stretches.forEach(({ begin, condition }, k) => {
    const from = Math.max(begin, behind),
      to = Math.min(stretches[k + 1]?.begin ?? ahead, ahead);
    if (to <= from) return;
    g.fillStyle = css(`--${condition}`);
    g.fillRect(px(from), top, px(to) - px(from), 12);
    if (px(to) - px(from) > 46) {
      g.fillStyle = css(`--on-${condition}`);
      g.textAlign = "left";
      g.textBaseline = "middle";
      g.fillText(condition, Math.max(px(from), 0) + 6, top + 6.5);
    }
  });
  const r = Math.min(0.5 * (top - 2), 26),
    [cx, cy] = [px(0), top - r];
  g.strokeStyle = css("--text");
  g.fillStyle = css("--card");
  g.lineWidth = 3;
  g.beginPath();
  g.arc(cx, cy, r - 1.5, 0, 2 * Math.PI);
  g.fill();
  g.stroke();
  g.lineWidth = 1.5;
  for (let k = 0; k < 3; k++) {
    const turned = angle + (k * Math.PI) / 3,
      [dx, dy] = [Math.sin(turned) * (r - 3), Math.cos(turned) * (r - 3)];
    line(g, cx - dx, cy + dy, cx + dx, cy - dy);
  }
}
