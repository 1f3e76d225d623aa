// The curves of the plots over the last 30 s. Live ones are gathered from the reports; the server knows those of a
// recording for any moment. A curve is [[s before now, value], ...] of "distance", "lower" (m), "tick" (us), or of a
// pair by its id (m).
import { isKnown } from "./format.js";

export const HISTORY_S = 30;
const TRIMMED_AT = 200; // points that are too old when they are removed
const FETCHED_AGAIN_S = 0.1; // time of the recording

// A page that is loaded again, because the cell has changed, goes on with the curves that it kept.
const KEPT = "clearance history";

export class LiveHistory {
  // `nameOf(id)`: the name of a pair, which is the same in every cell.
  constructor(nameOf) {
    this.nameOf = nameOf;
    this.points = JSON.parse(sessionStorage.getItem(KEPT) ?? "[]");
    sessionStorage.removeItem(KEPT);
  }
  // Keeps the least distance, the ticks and these pairs for the page that is loaded next.
  keep(chosen) {
    const curves = [...chosen].map((id) => [this.nameOf(id), this.pairAt(id)]);
    sessionStorage.setItem(KEPT, JSON.stringify(this.points.map((point) => ({ ...point, pairs: [],
      kept: Object.fromEntries(curves.map(([name, value]) => [name, value(point)])) }))));
  }

  // `minimum` is undefined while it is unknown.
  take(report, minimum, ns) {
    this.points.push({ s: ns * 1e-9, distance: minimum?.distance, lower: minimum?.lower, tick: tickOf(report), pairs: report.pairs });
    const first = this.points.findIndex(({ s }) => s > ns * 1e-9 - HISTORY_S);
    if (first > TRIMMED_AT) this.points.splice(0, first);
  }

  wish() {}

  curve(name) {
    const now = this.points.at(-1)?.s ?? 0;
    const value = typeof name === "number" ? this.pairAt(name) : (point) => point[name];
    return this.points.map((point) => [point.s - now, value(point)]);
  }

  // The published pairs have the same order in every report.
  pairAt(id) {
    const place = this.points.at(-1)?.pairs.findIndex(({ pair }) => pair === id);
    const name = this.nameOf(id);
    return ({ pairs, kept }) => (kept ? kept[name] : pairs[place] && isKnown(pairs[place]) ? pairs[place].distance : undefined);
  }
}

export class RecordedHistory {
  constructor(timeline) {
    this.begin = Number(timeline.begin_ns);
    this.now = 0;
    this.fetched = { end: NaN, chosen: "", s: [], pairs: {} };
  }

  take(report, minimum, ns) {
    this.now = (ns - this.begin) * 1e-9;
  }

  // Requests missing curves, one request at a time.
  async wish(chosen) {
    const pairs = [...chosen].join();
    const isThere = Math.abs(this.now - this.fetched.end) < FETCHED_AGAIN_S && pairs === this.fetched.chosen;
    if (this.isAsking || isThere) return;
    this.isAsking = true;
    const end = this.now;
    try {
      const answer = await fetch(`/history.json?end=${end}&pairs=${pairs}`);
      this.fetched = { end, chosen: pairs, ...(await answer.json()) };
    } catch {
      // The page says that the connection is lost.
    } finally {
      this.isAsking = false;
    }
  }

  curve(name) {
    const values = typeof name === "number" ? this.fetched.pairs[name] : this.fetched[name];
    return this.fetched.s.map((s, i) => [s - this.now, values?.[i] ?? undefined]).filter(([s]) => s <= 0 && s > -HISTORY_S);
  }
}

// The time from the begin of a tick to its report, us; undefined when it was not measured.
export function tickOf({ publish_ns, clock_offset_ns, now_ns }) {
  return publish_ns ? (publish_ns - clock_offset_ns - now_ns) * 1e-3 : undefined;
}
