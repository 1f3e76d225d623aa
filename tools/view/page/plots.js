// The last 30 s as lines: least distance with its lower bound, time of the tick, chosen pairs.
import { css, micro, mm, put } from "./format.js";
import { HISTORY_S, isKnown } from "./cell_state.js";

const AGAIN_MS = 66;
const HUES = ["--accent", "--lost", "--good", "--near", "--alarm", "--quiet"];

// A canvas with as many pixels as it has on the screen, and its drawing context, cleared.
export function fresh(canvas) {
  const sharp = window.devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * sharp) || canvas.height !== Math.round(height * sharp)) {
    canvas.width = Math.round(width * sharp);
    canvas.height = Math.round(height * sharp);
  }
  const context = canvas.getContext("2d");
  context.setTransform(sharp, 0, 0, sharp, 0, 0);
  context.clearRect(0, 0, width, height);
  return { context, width, height };
}

// 1, 2 or 5 times a power of ten, not below the value.
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-12)));
  return [1, 2, 5, 10].map((each) => each * power).find((each) => each >= value * 0.999);
}

class Plot {
  constructor(id) {
    this.canvas = document.getElementById(id);
  }

  // `lines`: [{colour, points: [[s, value], ...], fill}]; `marks`: horizontal ones [{value, colour}]. s: before now.
  draw(lines, marks = []) {
    const { context, width, height } = fresh(this.canvas);
    const values = lines.flatMap(({ points }) => points.map(([, value]) => value)).filter(Number.isFinite);
    const least = Math.min(0, ...values), most = values.length ? roundUp(Math.max(1e-9, ...values) * 1.02) : 100;
    const left = 34, bottom = 4;
    const x = (s) => left + (width - left) * (1 + s / HISTORY_S);
    const y = (value) => 4 + (height - 4 - bottom) * (1 - (value - least) / (most - least));
    this.axes(context, { x, y, least, most, left, width, height });
    for (const { value, colour } of marks) this.mark(context, y(value), left, width, colour, value < most);
    for (const line of lines) this.line(context, line, x, y, y(least));
  }

  axes(context, { x, y, least, most, left, width, height }) {
    context.font = "10px system-ui, sans-serif";
    context.fillStyle = css("--quiet");
    context.strokeStyle = css("--line");
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const value of [0, most / 2, most].filter((each) => each >= least)) {
      context.beginPath();
      context.moveTo(left, y(value));
      context.lineTo(width, y(value));
      context.stroke();
      context.fillText(String(Number(value.toPrecision(3))), left - 5, Math.min(height - 6, Math.max(7, y(value))));
    }
    for (let s = -20; s < 0; s += 10) {
      context.beginPath();
      context.moveTo(x(s), 4);
      context.lineTo(x(s), height - 4);
      context.stroke();
    }
  }

  mark(context, at, left, width, colour, visible) {
    if (!visible) return;
    context.strokeStyle = colour;
    context.setLineDash([5, 4]);
    context.beginPath();
    context.moveTo(left, at);
    context.lineTo(width, at);
    context.stroke();
    context.setLineDash([]);
  }

  line(context, { colour, points, fill }, x, y, base) {
    context.strokeStyle = colour;
    context.lineWidth = 1.6;
    context.beginPath();
    let pen = false;
    for (const [s, value] of points) {
      if (Number.isFinite(value)) context[pen ? "lineTo" : "moveTo"](x(s), y(value));
      pen = Number.isFinite(value);
    }
    context.stroke();
    context.lineWidth = 1;
    if (fill) this.fill(context, points.filter(([, value]) => Number.isFinite(value)), colour, x, y, base);
  }

  // Below the line, a column a point, so that gaps stay gaps.
  fill(context, points, colour, x, y, base) {
    context.globalAlpha = 0.14;
    context.fillStyle = colour;
    points.forEach(([s, value], i) => {
      const next = x(points[i + 1]?.[0] ?? s);
      if (next - x(s) < 12) context.fillRect(x(s), y(value), next - x(s), base - y(value));
    });
    context.globalAlpha = 1;
  }
}

export class Plots {
  constructor() {
    this.minimum = new Plot("plot-minimum");
    this.tick = new Plot("plot-tick");
    this.pairs = new Plot("plot-chosen");
    this.figure = document.getElementById("chosen");
    this.drawnMs = 0;
  }

  draw(state, chosen, nowMs) {
    if (nowMs - this.drawnMs < AGAIN_MS || !state.history.length) return;
    this.drawnMs = nowMs;
    const now = state.history.at(-1).s;
    const series = (value) => state.history.map((at) => [at.s - now, value(at)]);
    const thresholds = state.scene.zones.slice(0, 4).map(({ enter_below }) => ({ value: 1e3 * enter_below, colour: css("--alarm") }));
    // A recording knows what was before it was moved to where it is.
    const before = state.timeline?.stretches.map(([s, , lower]) => [s + Number(state.timeline.begin_ns) * 1e-9 - now, lower === null ? NaN : 1e3 * lower])
      .filter(([s]) => s <= 0 && s > -HISTORY_S);
    this.minimum.draw([{ colour: css("--accent"), fill: true, points: before ?? series(({ lower }) => 1e3 * lower) }], thresholds);
    const { distance } = state.history.at(-1);
    put(document.getElementById("plot-minimum-now"), distance === undefined ? "not known" : `${mm(distance, 2)} mm`);
    this.tick.draw([{ colour: css("--good"), points: series(({ tick }) => tick) }]);
    const { tick } = state.history.at(-1);
    put(document.getElementById("plot-tick-now"), tick === undefined ? "not recorded" : micro(tick));
    this.chosen(state, chosen, now);
  }

  chosen(state, chosen, now) {
    this.figure.hidden = chosen.size === 0;
    if (!chosen.size) return;
    const lines = [...chosen].slice(0, HUES.length).map((id, i) => {
      const place = state.report.pairs.findIndex(({ pair }) => pair === id);
      const points = state.history.map(({ s, pairs }) => [s - now, isKnown(pairs[place] ?? { status: 9 }) ? 1e3 * pairs[place].distance : NaN]);
      return { colour: css(HUES[i]), points };
    });
    this.pairs.draw(lines);
  }
}
