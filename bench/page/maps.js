// Pictures of the contact patch from above, on canvases of their own.
"use strict";

const INFERNO = ["#000004", "#1b0c41", "#4a0c6b", "#781c6d", "#a52c60", "#cf4446", "#ed6925", "#fb9b06", "#f7d13d", "#fcffa4"];
const VIRIDIS = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];

// Values of the style, kept until the theme changes: asking takes longer than drawing.
const style = new Map();
function css(name) {
  if (!style.has(name)) style.set(name, getComputedStyle(document.documentElement).getPropertyValue(name).trim());
  return style.get(name);
}
const channels = (c) => [1, 3, 5].map((k) => parseInt(c.slice(k, k + 2), 16));

// A table of 256 colours between given ones.
function palette(colours) {
  const stops = colours.map(channels);
  return Array.from({ length: 256 }, (_, k) => {
    const at = (k / 255) * (stops.length - 1),
      low = Math.min(Math.floor(at), stops.length - 2);
    return stops[low].map((c, i) => Math.round(c + (at - low) * (stops[low + 1][i] - c)));
  });
}

const PALETTES = { inferno: palette(INFERNO), viridis: palette(VIRIDIS) };

// Gives a canvas the number of pixels of its place on the screen, and its pen in units of CSS pixels.
function pen(canvas) {
  const ratio = Math.min(window.devicePixelRatio || 1, 3),
    width = canvas.clientWidth,
    height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const g = canvas.getContext("2d");
  g.setTransform(ratio, 0, 0, ratio, 0, 0);
  g.clearRect(0, 0, width, height);
  g.font = "12px " + css("--font");
  return { g, width, height };
}

// Round numbers between two ends.
function ticks(low, high, most) {
  const raw = (high - low) / most,
    power = 10 ** Math.floor(Math.log10(raw)),
    step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= raw * 0.999),
    found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(Number((k * step).toPrecision(12)));
  return found;
}

const shown = (value, digits = 3) => {
  if (!Number.isFinite(value)) return "–";
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6)) return value.toExponential(1).replace("-", "−");
  return Number(value.toPrecision(digits)).toString().replace("-", "−");
};

// A map of one quantity.
class PatchPicture {
  constructor(canvas) {
    this.canvas = canvas;
    this.cells = document.createElement("canvas");
  }

  // Colours of the cells from numbers between 0 and 1, as pixels of a small canvas.
  paint(along, across, colourOf) {
    const { cells } = this;
    cells.width = along;
    cells.height = across;
    const g = cells.getContext("2d"),
      image = g.createImageData(along, across);
    for (let row = 0; row < across; row++)
      for (let column = 0; column < along; column++) {
        // Rows of pixels go down, z goes up.
        const pixel = 4 * ((across - 1 - row) * along + column),
          colour = colourOf(row * along + column);
        image.data.set(colour, pixel);
        image.data[pixel + 3] = colour.length === 4 ? colour[3] : 255;
      }
    g.putImageData(image, 0, 0);
  }

  // Draws the cells, within an outline, with axes in millimetres: lengths along and across alike. The canvas gets the height
  // that this takes, within limits.
  draw({ x, z, outline, legend }) {
    const [left, right, top, bottom] = [42, 62, 8, 32],
      size = [x[1] - x[0], z[1] - z[0]],
      wanted = ((this.canvas.clientWidth - left - right) * size[1]) / size[0] + top + bottom,
      fitting = `${Math.round(Math.max(130, Math.min(wanted, 0.6 * innerHeight)))}px`;
    if (this.canvas.style.height !== fitting) this.canvas.style.height = fitting;
    const { g, width, height } = pen(this.canvas),
      room = [width - left - right, height - top - bottom],
      scale = Math.min(room[0] / size[0], room[1] / size[1]),
      box = [size[0] * scale, size[1] * scale],
      at = [left + (room[0] - box[0]) / 2, top + (room[1] - box[1]) / 2],
      place = (mm, end) => (end ? at[1] + box[1] * (1 - (mm - z[0]) / size[1]) : at[0] + (box[0] * (mm - x[0])) / size[0]);
    g.save();
    if (outline.length) {
      g.beginPath();
      for (const part of outline) {
        part.forEach(([along, across], k) => (k ? g.lineTo : g.moveTo).call(g, place(along, 0), place(across, 1)));
        g.closePath();
      }
      g.clip();
    }
    g.imageSmoothingEnabled = this.cells.height > 1;
    g.drawImage(this.cells, at[0], at[1], box[0], box[1]);
    g.restore();
    g.strokeStyle = css("--line");
    g.strokeRect(at[0] + 0.5, at[1] + 0.5, box[0] - 1, box[1] - 1);
    g.fillStyle = css("--soft");
    g.textAlign = "center";
    g.textBaseline = "top";
    for (const mm of ticks(...x, Math.max(2, box[0] / 45))) g.fillText(shown(mm), place(mm, 0), at[1] + box[1] + 4);
    g.fillText("x [mm], travel →", at[0] + box[0] / 2, at[1] + box[1] + 18);
    g.textAlign = "right";
    g.textBaseline = "middle";
    for (const mm of ticks(...z, Math.max(2, box[1] / 30))) g.fillText(shown(mm), at[0] - 5, place(mm, 1));
    g.save();
    g.translate(at[0] - 34, at[1] + box[1] / 2);
    g.rotate(-Math.PI / 2);
    g.textAlign = "center";
    g.fillText("z [mm]", 0, 0);
    g.restore();
    legend(g, at[0] + box[0] + 10, at[1], Math.max(box[1], 60));
  }
}

// Bars of colours side by side, with both ends and the unit.
function bar(g, x, y, height, bars, low, high, unit) {
  const room = height - 14;
  bars.forEach((colours, b) =>
    colours.forEach((c, k) => {
      g.fillStyle = `rgb(${c.join()})`;
      g.fillRect(x + (10 * b) / bars.length, y + 14 + (room * (colours.length - 1 - k)) / colours.length, 10 / bars.length, room / colours.length + 1);
    }),
  );
  g.fillStyle = css("--soft");
  g.textAlign = "left";
  g.textBaseline = "top";
  g.fillText(unit, x, y - 2);
  g.fillText(shown(high), x + 14, y + 13);
  g.textBaseline = "bottom";
  g.fillText(shown(low), x + 14, y + height + 1);
}
