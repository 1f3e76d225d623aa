// The last seconds or minutes as curves, drawn by uPlot: the least distance and its lower bound, the time of the tick,
// the speed scaling of zones, where cameras see links, and distances or closing speeds of chosen pairs.
import uPlot from "uplot";
import { axisOf, ticksOf } from "./axis.js";
import { css, micro, mm, put } from "./format.js";
import { tickOf } from "./history.js";

const AGAIN_MS = 100, LONG_AGAIN_MS = 500; // between drawings, and between those of minutes
const SHORT_S = 60;
const MOST_THRESHOLDS = 4;
const HUES = ["--accent", "--lost", "--good", "--near", "--alarm", "--quiet"];

// A number with at most five characters.
const axisNumber = (value) => (Math.abs(value) < 1e4 ? String(Number(value.toPrecision(3))) : `${Number((1e-3 * value).toPrecision(3))}k`).replace("-", "−");

// "20 s ago" as an axis has it.
const ago = (s) => (s <= -120 ? `−${Number((-s / 60).toPrecision(2))} min` : `−${Math.round(-s)} s`);

// Functions give the colours, since the theme may change.
const curve = (hue, more) => ({ stroke: () => css(hue), width: 1.6, points: { show: false }, ...more });
const filled = (hue) => curve(hue, { fill: () => `color-mix(in srgb, ${css(hue)} 14%, transparent)` });
// A horizontal line that does not stretch the axis.
const threshold = () => curve("--alarm", { width: 1, dash: [5, 4], auto: false });

const valueRange = (plot, least, most) => axisOf(least ?? NaN, most ?? NaN);

class Plot {
  // `span()`: the width in s.
  constructor(id, series, span) {
    this.element = document.getElementById(id);
    const grid = { stroke: () => css("--line"), width: 1 }, ticks = { show: false }, font = "10px system-ui, sans-serif", stroke = () => css("--quiet");
    this.plot = new uPlot({
      ...this.size(), legend: { show: false }, cursor: { show: false }, padding: [7, 0, 0, 0],
      scales: { x: { time: false, range: () => [-span(), 0] }, y: { range: valueRange } },
      axes: [
        { size: 13, gap: 1, grid, ticks, font, stroke, splits: () => [(-2 / 3) * span(), (-1 / 3) * span()], values: (plot, splits) => splits.map(ago) },
        { size: 34, gap: 5, grid, ticks, font, stroke,
          splits: (plot, axis, low, high) => ticksOf(low, high), values: (plot, splits) => splits.map(axisNumber) },
      ],
      series: [{}, ...series],
    }, [[]], this.element);
  }

  size() {
    return { width: Math.max(80, this.element.clientWidth), height: this.element.clientHeight };
  }

  // `columns`: the times, s before now, then the values of each series; values that are not finite are gaps.
  draw(columns) {
    const { width, height } = this.size();
    if (this.plot.width !== width || this.plot.height !== height) this.plot.setSize({ width, height });
    this.plot.setData(columns.map((column) => column.map((value) => (Number.isFinite(value) ? value : null))));
  }
}

const times = (curve) => curve.map(([s]) => s);
const values = (curve, factor = 1) => curve.map(([, value]) => factor * value);

// The names of curves in their colours.
function nameCurves(id, texts) {
  const names = document.getElementById(id), key = texts.join();
  if (names.dataset.shown === key) return;
  names.dataset.shown = key;
  names.replaceChildren(...texts.map((text, i) => {
    const name = Object.assign(document.createElement("span"), { textContent: text, title: text });
    name.style.setProperty("--mark", `var(${HUES[i]})`);
    return name;
  }));
}

export class Plots {
  constructor() {
    this.choices = { span: document.getElementById("span"), quantity: document.getElementById("quantity") };
    for (const choice of Object.values(this.choices)) choice.onchange = () => (this.drawnMs = 0);
    const span = () => this.span;
    this.minimum = new Plot("plot-minimum", [filled("--accent"), curve("--accent"), ...Array.from({ length: MOST_THRESHOLDS }, threshold)], span);
    this.tick = new Plot("plot-tick", [curve("--good")], span);
    this.made = {}; // those that are hidden at first
    this.drawnMs = 0;
  }

  // s
  get span() {
    return Number(this.choices.span.value);
  }

  draw(state, chosen, nowMs) {
    if (nowMs - this.drawnMs < (this.span > SHORT_S ? LONG_AGAIN_MS : AGAIN_MS) || !state.report) return;
    this.drawnMs = nowMs;
    state.history.wish(chosen, this.span);
    this.drawMinimum(state);
    this.drawTick(state);
    this.drawScaling(state);
    this.drawResiduals(state);
    this.drawChosen(state, chosen);
  }

  // The distance is a line; below its lower bound, the area is filled.
  drawMinimum(state) {
    const { scene, history } = state, minimum = state.minimum();
    const lower = history.curve("lower", this.span), levels = Array.from({ length: MOST_THRESHOLDS }, (_, i) => 1e3 * scene.zones[i]?.enter_below);
    this.minimum.draw([times(lower), values(lower, 1e3), values(history.curve("distance", this.span), 1e3), ...levels.map((level) => lower.map(() => level))]);
    put(document.getElementById("plot-minimum-now"), minimum ? mm(minimum.distance, 2) : "not known");
  }

  drawTick({ report, history }) {
    const curve = history.curve("tick", this.span), tick = tickOf(report);
    this.tick.draw([times(curve), values(curve)]);
    put(document.getElementById("plot-tick-now"), tick === undefined ? "not recorded" : micro(tick));
  }

  // A figure has no size before it is shown, and its plot is made then.
  shown(name, isShown, series) {
    document.getElementById(name).hidden = !isShown;
    return isShown && (this.made[name] ??= new Plot(`plot-${name}`, series(), () => this.span));
  }

  drawScaling({ history, scaling }) {
    const plot = this.shown("scaling", scaling !== undefined, () => [curve("--near")]);
    if (!plot) return;
    const curveNow = history.curve("scaling", this.span);
    plot.draw([times(curveNow), values(curveNow)]);
    put(document.getElementById("plot-scaling-now"), scaling.toFixed(2));
  }

  drawResiduals({ history }) {
    const shown = history.residuals(this.span), plot = this.shown("residuals", shown.length > 0, () => HUES.map((hue) => curve(hue)));
    if (!plot) return;
    const at = [...new Set(shown.flatMap(([, curve]) => times(curve)))].sort((a, b) => a - b);
    const curves = shown.map(([, curve]) => new Map(curve));
    plot.draw([at, ...HUES.map((_, i) => at.map((s) => 1e3 * (curves[i]?.get(s) ?? NaN)))]);
    nameCurves("plot-residuals-names", shown.map(([name]) => name));
  }

  drawChosen({ pairs, history }, chosen) {
    const plot = this.shown("chosen", chosen.size > 0, () => HUES.map((hue) => curve(hue)));
    if (!plot) return;
    const of = this.choices.quantity.value, shown = [...chosen].slice(0, HUES.length);
    const curves = HUES.map((_, i) => history.curve(shown[i] ?? shown[0], this.span, undefined, of));
    plot.draw([times(curves[0]), ...curves.map((curve, i) => values(curve, i >= shown.length ? NaN : of === "distance" ? 1e3 : 1))]);
    nameCurves("plot-chosen-names", shown.map((id) => pairs[id].name));
  }
}
