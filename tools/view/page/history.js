// The curves of the plots over the last minutes. Live ones are gathered from the reports; the server knows those of a
// recording for any moment. Where a curve has more points than a plot has pixels, a point is the least distance, the
// longest tick, the least scaling, or the greatest closing speed of its stretch of time.
import { isKnown } from "./format.js";

export const LONGEST_S = 600;
const MOST_POINTS = 600; // of a curve
const SHORTEST_S = 1 / 60; // of a stretch
const MOST_VALUES = 4e6; // of each array with a column per pair: 16 MB
const SPARE = 4; // columns beyond the pairs of the first report
const MOST_RESIDUALS = 6; // curves
const FETCHED_AGAIN_S = 0.1; // time of the recording

// How two values of a stretch become one.
const least = (a, b) => (a <= b || b !== b ? a : b), most = (a, b) => (a >= b || b !== b ? a : b);
const JOINED = { distance: least, lower: least, tick: most, scaling: least, speed: most };
const HEADS = ["distance", "lower", "tick", "scaling"];

// A page that is loaded again, because the cell has changed, goes on with the curves that it kept.
const KEPT = "clearance history";

// A ring of stretches of time, each with the figures of the whole cell and a column per pair.
export class LiveHistory {
  // `nameOf(id)`: the name of a pair, which is the same in every cell.
  constructor(nameOf) {
    this.nameOf = nameOf;
    this.columns = new Map(); // by the pair's id
    this.medians = new Map(); // of residuals, [[s, m], ...], by the names of a camera and a link
  }

  begin(pairs) {
    for (const { pair } of pairs) this.columns.set(pair, this.columns.size);
    this.width = this.columns.size + SPARE;
    this.size = Math.max(2, Math.min(LONGEST_S / SHORTEST_S, Math.floor(MOST_VALUES / this.width)));
    this.length = LONGEST_S / this.size;
    this.time = new Float64Array(this.size);
    this.heads = Object.fromEntries(HEADS.map((name) => [name, new Float32Array(this.size)]));
    this.pairs = { distance: new Float32Array(this.size * this.width), speed: new Float32Array(this.size * this.width) };
    this.first = this.count = 0;
    this.restore();
  }

  // Keeps the figures of the whole cell and the distances of these pairs for the page that is loaded next.
  keep(chosen) {
    if (!this.time) return;
    const curves = [...HEADS, ...chosen].map((name) => [typeof name === "number" ? this.nameOf(name) : name, this.curve(name, LONGEST_S, 4 * MOST_POINTS)]);
    sessionStorage.setItem(KEPT, JSON.stringify({ end: this.time[this.slot(this.count - 1)], curves }));
  }
  restore() {
    const kept = JSON.parse(sessionStorage.getItem(KEPT) ?? "null");
    sessionStorage.removeItem(KEPT);
    if (!kept) return;
    this.goesOn = true;
    const ids = new Map([...this.columns.keys()].map((id) => [this.nameOf(id), id]));
    kept.curves[0][1].forEach(([s], i) => {
      const at = this.slotAt(kept.end + s);
      for (const [name, curve] of kept.curves) {
        const value = curve[i]?.[1] ?? NaN;
        if (HEADS.includes(name)) this.heads[name][at] = value;
        else if (ids.has(name)) this.pairs.distance[at * this.width + this.columns.get(ids.get(name))] = value;
      }
    });
  }

  slot(i) {
    return (this.first + i) % this.size;
  }
  // The place of the stretch with this time, s: the last one, or a new one without values.
  slotAt(s) {
    const last = this.slot(this.count - 1);
    if (this.count && s < this.time[last]) this.count = 0; // the clock went back
    if (this.count && Math.floor(s / this.length) === Math.floor(this.time[last] / this.length)) return last;
    if (this.count === this.size) this.first = this.slot(1);
    else ++this.count;
    const at = this.slot(this.count - 1);
    this.time[at] = s;
    for (const name of HEADS) this.heads[name][at] = NaN;
    for (const values of Object.values(this.pairs)) values.fill(NaN, at * this.width, (at + 1) * this.width);
    return at;
  }

  // `minimum` is undefined while it is unknown, `scaling` while nothing has one.
  take(report, minimum, scaling, ns) {
    if (!this.time) this.begin(report.pairs);
    const at = this.slotAt(ns * 1e-9);
    const join = (values, i, name, value) => (values[i] = JOINED[name](values[i], value ?? NaN));
    const heads = { distance: minimum?.distance, lower: minimum?.lower, tick: tickOf(report), scaling };
    for (const name of HEADS) join(this.heads[name], at, name, heads[name]);
    for (const pair of report.pairs) {
      const column = this.columns.get(pair.pair);
      if (column === undefined || !isKnown(pair)) continue;
      join(this.pairs.distance, at * this.width + column, "distance", pair.distance);
      join(this.pairs.speed, at * this.width + column, "speed", pair.closing_speed);
    }
  }
  // Health has the residuals of links that cameras see.
  takeHealth({ witnesses = [] }, ns) {
    const now = ns * 1e-9;
    for (const { sensor, link, residual_p50 } of witnesses) {
      const name = `${sensor}: ${link}`, before = this.medians.get(name) ?? [];
      if (link && residual_p50 === residual_p50)
        this.medians.set(name, [...before.filter(([s]) => s > now - LONGEST_S && s < now), [now, residual_p50]]);
    }
    this.healthS = now;
  }
  // [["camera: link", [[s before now, m], ...]], ...]: those that are largest in the last `span` s.
  residuals(span) {
    const largest = ([, curve]) => Math.max(...curve.map(([, m]) => Math.abs(m)));
    return [...this.medians].map(([name, curve]) => [name, curve.map(([s, m]) => [s - this.healthS, m]).filter(([s]) => s > -span)])
      .filter(([, curve]) => curve.length).sort((a, b) => largest(b) - largest(a)).slice(0, MOST_RESIDUALS);
  }
  // A pair that is added later, or means other objects from now on.
  renew(id) {
    if (!this.time) return;
    if (!this.columns.has(id) && this.columns.size < this.width) this.columns.set(id, this.columns.size);
    const column = this.columns.get(id);
    if (column !== undefined) for (const values of Object.values(this.pairs)) for (let i = column; i < values.length; i += this.width) values[i] = NaN;
  }

  wish() {}

  // [[s before now, value], ...] over the last `span` s: of "distance", "lower" (m), "tick" (us), "scaling" (0 to 1), or
  // of a pair by its id, whose `of` is "distance" (m) or "speed" (m/s).
  curve(name, span, points = MOST_POINTS, of = "distance") {
    if (!this.count) return [];
    const isPair = typeof name === "number", column = this.columns.get(name);
    const values = isPair ? this.pairs[of] : this.heads[name], join = JOINED[isPair ? of : name];
    const valueAt = (at) => (!isPair ? values[at] : column === undefined ? NaN : values[at * this.width + column]);
    const now = this.time[this.slot(this.count - 1)], found = [];
    const step = Math.max(this.length, span / points);
    let number;
    for (let i = this.after(now - span); i < this.count; ++i) {
      const at = this.slot(i), s = this.time[at], next = Math.floor(s / step), value = valueAt(at);
      if (next === number) found.at(-1)[1] = join(found.at(-1)[1], value);
      else found.push([s - now, value]);
      number = next;
    }
    return found;
  }
  // The number of the first stretch after this time, s.
  after(s) {
    let low = 0, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[this.slot(middle)] > s) high = middle;
      else low = middle + 1;
    }
    return low;
  }
}

export class RecordedHistory {
  constructor(timeline) {
    this.begin = Number(timeline.begin_ns);
    this.now = 0;
    this.fetched = { end: NaN, asked: "", s: [], pairs: {}, speeds: {}, residuals: {} };
  }

  take(report, minimum, scaling, ns) {
    this.now = (ns - this.begin) * 1e-9;
  }
  takeHealth() {}
  renew() {}

  // Requests missing curves, one request at a time.
  async wish(chosen, span) {
    const asked = `width=${span}&pairs=${[...chosen].join()}`;
    const isThere = Math.abs(this.now - this.fetched.end) < FETCHED_AGAIN_S && asked === this.fetched.asked;
    if (this.isAsking || isThere) return;
    this.isAsking = true;
    const end = this.now;
    try {
      const answer = await fetch(`/history.json?end=${end}&${asked}`);
      this.fetched = { end, asked, ...(await answer.json()) };
    } catch {
      // The page says that the connection is lost.
    } finally {
      this.isAsking = false;
    }
  }

  curve(name, span, points, of = "distance") {
    const { s, pairs, speeds } = this.fetched;
    const values = typeof name === "number" ? (of === "speed" ? speeds : pairs)[name] : this.fetched[name];
    return s.map((each, i) => [each - this.now, values?.[i] ?? undefined]).filter(([each]) => each <= 0 && each > -span);
  }
  // The server has chosen the largest.
  residuals(span) {
    return Object.entries(this.fetched.residuals).map(([name, curve]) => [name, curve.map(([s, m]) => [s - this.now, m]).filter(([s]) => s <= 0 && s > -span)]);
  }
}

// The time from the begin of a tick to its report, us; undefined when it was not measured.
export function tickOf({ publish_ns, clock_offset_ns, now_ns }) {
  return publish_ns ? (publish_ns - clock_offset_ns - now_ns) * 1e-3 : undefined;
}
