// The last 30 s as lines: least distance with its lower bound, time of the tick, chosen pairs.
import { css, micro, mm, put } from "./format.js";
import { HISTORY_S, tickOf } from "./history.js";

const AGAIN_MS = 66;
const MOST_THRESHOLDS = 4;
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

// At most five characters.
const axisNumber = (value) => (Math.abs(value) < 1e4 ? String(Number(value.toPrecision(3))) : `${Number((1e-3 * value).toPrecision(3))}k`);

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
      context.fillText(axisNumber(value), left - 5, Math.min(height - 6, Math.max(7, y(value))));
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
    context.lineCap = "round";
    let pen = false;
    for (const [s, value] of points) {
      if (!Number.isFinite(value)) {
        pen = false;
        continue;
      }
      if (!pen) context.moveTo(x(s), y(value));
      context.lineTo(x(s), y(value)); // a single point is a dot
      pen = true;
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

const inMm = (curve) => curve.map(([s, metres]) => [s, 1e3 * metres]);

export class Plots {
  constructor() {
    this.minimum = new Plot("plot-minimum");
    this.tick = new Plot("plot-tick");
    this.pairs = new Plot("plot-chosen");
    this.figure = document.getElementById("chosen");
    this.drawnMs = 0;
  }

  draw(state, chosen, nowMs) {
    if (nowMs - this.drawnMs < AGAIN_MS || !state.report) return;
    this.drawnMs = nowMs;
    state.history.wish(chosen);
    this.drawMinimum(state);
    this.drawTick(state);
    this.drawChosen(state, chosen);
  }

  // The distance as a line, what is proved as what lies below it.
  drawMinimum(state) {
    const { scene, history } = state, minimum = state.minimum();
    const thresholds = scene.zones.slice(0, MOST_THRESHOLDS).map(({ enter_below }) => ({ value: 1e3 * enter_below, colour: css("--alarm") }));
    const lower = { colour: css("--accent"), points: inMm(history.curve("lower")), fill: true };
    this.minimum.draw([lower, { colour: css("--accent"), points: inMm(history.curve("distance")) }], thresholds);
    put(document.getElementById("plot-minimum-now"), minimum ? `${mm(minimum.distance, 2)} mm` : "not known");
  }

  drawTick({ report, history }) {
    this.tick.draw([{ colour: css("--good"), points: history.curve("tick") }]);
    const tick = tickOf(report);
    put(document.getElementById("plot-tick-now"), tick === undefined ? "not recorded" : micro(tick));
  }

  drawChosen({ pairs, history }, chosen) {
    this.figure.hidden = chosen.size === 0;
    if (!chosen.size) return;
    const shown = [...chosen].slice(0, HUES.length);
    this.pairs.draw(shown.map((id, i) => ({ colour: css(HUES[i]), points: inMm(history.curve(id)) })));
    const names = document.getElementById("plot-chosen-names");
    if (names.dataset.shown === shown.join()) return;
    names.dataset.shown = shown.join();
    names.replaceChildren(...shown.map((id, i) => {
      const name = Object.assign(document.createElement("span"), { textContent: pairs[id].name });
      name.style.setProperty("--mark", `var(${HUES[i]})`);
      return name;
    }));
  }
}
