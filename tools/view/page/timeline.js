// The time line of a recording: least distance over time, zones, marked moments; dragging moves the recording.
import { axisOf, ticksOf } from "./axis.js";
import { css, mm, put, roundUp, seconds } from "./format.js";

const element = (id) => document.getElementById(id);
const MARK = { closest: "--alarm", zone: "--near", overrun: "--lost", cell: "--text" };
const LEFT = 54, TOP = 6;

// A canvas with its pixels on the screen, and its cleared drawing context.
function fresh(canvas) {
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

export class Timeline {
  // `timeline` is /timeline.json; set(name, value) sets a parameter of the server.
  constructor(timeline, zones, set) {
    Object.assign(this, { timeline, zones, set, time: 0, playing: false, rate: 1 });
    element("timeline").hidden = false;
    this.canvas = element("track");
    element("play").onclick = () => this.play();
    element("back").onclick = () => this.step(-1);
    element("forward").onclick = () => this.step(1);
    element("worst").onclick = () => this.worst();
    element("next-moment").onclick = () => this.nextMoment();
    element("rate").onchange = ({ target }) => this.set("playback.rate", Number(target.value));
    this.drags();
  }

  parameters(values) {
    this.playing = values["playback.playing"] ?? this.playing;
    this.rate = values["playback.rate"] ?? this.rate;
    put(element("play"), this.playing ? "❚❚" : "▶");
    const known = [...element("rate").options].find(({ value }) => Number(value) === this.rate);
    if (known) element("rate").value = known.value;
  }

  play() {
    this.set("playback.playing", !this.playing);
  }
  step(reports) {
    this.set("playback.step", reports);
  }
  go(time) {
    this.set("playback.time", Math.min(this.timeline.duration, Math.max(0, time)));
  }
  faster(by) {
    const rates = [...element("rate").options].map(({ value }) => Number(value));
    const at = rates.findIndex((rate) => rate >= this.rate);
    this.set("playback.rate", rates[Math.min(rates.length - 1, Math.max(0, at + by))]);
  }
  worst() {
    const moment = this.timeline.moments.find(({ kind }) => kind === "closest");
    if (moment) this.go(moment.time);
  }
  nextMoment() {
    const { moments } = this.timeline;
    const moment = moments.find(({ time }) => time > this.time + 1e-6) ?? moments[0];
    if (moment) this.go(moment.time);
  }

  drags() {
    const timeAt = ({ clientX }) => {
      const box = this.canvas.getBoundingClientRect();
      return ((clientX - box.left - LEFT) / (box.width - LEFT - 8)) * this.timeline.duration;
    };
    // Near a mark, the time of the mark.
    const snapped = (time) => {
      const near = 6 / (this.canvas.clientWidth - LEFT) * this.timeline.duration;
      return this.timeline.moments.find((moment) => Math.abs(moment.time - time) < near)?.time ?? time;
    };
    this.canvas.onpointerdown = (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      this.dragging = true;
      this.go(snapped(timeAt(event)));
    };
    this.canvas.onpointermove = (event) => this.dragging && this.go(timeAt(event));
    this.canvas.onpointerup = this.canvas.onpointercancel = () => (this.dragging = false);
  }

  // `time`: s after the first report.
  draw(time) {
    this.time = time;
    put(element("time"), `${seconds(time)} of ${seconds(this.timeline.duration, 1)}`);
    const here = this.timeline.moments.find((moment) => Math.abs(moment.time - time) < 0.0015);
    put(element("moment"), here?.text ?? "");
    const { context, width, height } = fresh(this.canvas);
    const duration = Math.max(1e-9, this.timeline.duration), span = width - LEFT - 8;
    const x = (s) => LEFT + (s / duration) * span;
    this.drawZones(context, x, height);
    this.drawDistance(context, x, height, width);
    this.drawMoments(context, x, height);
    context.fillStyle = css("--text");
    context.fillRect(x(time) - 1, 0, 2, height);
    context.beginPath();
    context.arc(x(time), 5, 5, 0, 7);
    context.fill();
  }

  drawZones(context, x, height) {
    context.globalAlpha = 0.2;
    context.fillStyle = css("--alarm");
    for (const { begin, end } of this.timeline.zones) context.fillRect(x(begin), TOP, Math.max(1, x(end) - x(begin)), height - TOP - 14);
    context.globalAlpha = 1;
  }

  drawDistance(context, x, height, width) {
    const known = this.timeline.stretches.filter(([, distance]) => distance !== null);
    const values = known.map(([, distance]) => 1e3 * distance);
    const [low, high] = axisOf(Math.min(...values), Math.max(...values));
    const floor = height - 14;
    const y = (value) => TOP + (floor - TOP) * (1 - (value - low) / (high - low));
    context.font = "10px system-ui, sans-serif";
    context.fillStyle = css("--quiet");
    context.strokeStyle = css("--line");
    context.textAlign = "right";
    for (const value of low < 0 ? ticksOf(low, high) : [low, high]) {
      context.fillText(`${mm(1e-3 * value, 0)} mm`, LEFT - 5, Math.min(floor, Math.max(TOP + 8, y(value) + 4)));
      context.strokeRect(LEFT, y(value), width - LEFT - 8, 0);
    }
    context.textAlign = "center";
    const step = roundUp(this.timeline.duration / 12);
    for (let s = 0; s <= this.timeline.duration; s += step) context.fillText(`${Number(s.toFixed(3))} s`, Math.max(LEFT + 8, x(s)), height - 2);
    context.strokeStyle = css("--accent");
    context.lineWidth = 1.5;
    context.beginPath();
    let pen = false;
    for (const [s, distance] of this.timeline.stretches) {
      if (distance !== null) context[pen ? "lineTo" : "moveTo"](x(s), y(1e3 * distance));
      pen = distance !== null;
    }
    context.stroke();
    context.lineWidth = 1;
  }

  drawMoments(context, x, height) {
    for (const { time, kind } of this.timeline.moments) {
      context.fillStyle = css(MARK[kind]);
      context.beginPath();
      const tall = kind === "closest" ? 9 : 6;
      context.moveTo(x(time), height - 14 - tall);
      context.lineTo(x(time) - tall / 1.6, height - 14);
      context.lineTo(x(time) + tall / 1.6, height - 14);
      context.fill();
    }
  }
}
