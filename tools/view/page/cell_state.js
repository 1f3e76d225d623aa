// The known state of the cell: the latest report, zones, health, and the alarms.
import { age, counted, isKnown, STATUS } from "./format.js";
import { LiveHistory, RecordedHistory } from "./history.js";

const OVERLAPPING = STATUS.indexOf("overlapping");
const ALLOWED = 1; // ContactStatus of monitor/interface/report.hpp
const SILENT_S = 1.0;
const TOLD_FOR_S = 5.0; // display time of an overrun
const LIVE = ["partners", "refused"]; // the server's statuses while what is shown is the present state all the same
const HEALTH_AGAIN_S = 2.5; // a longer gap means that a recording was moved

export class CellState {
  constructor(scene, timeline) {
    this.scene = scene;
    this.timeline = timeline;
    this.zones = new Map();
    this.statuses = new Map();
    this.connected = false;
    this.timeNs = 0;
    this.limiting = new Set(); // pairs from which a robot would not stop clear
    this.history = timeline ? new RecordedHistory(timeline) : new LiveHistory((id) => this.pairs[id].name);
    this.measuredId = scene.pairs.length; // of the pair that a person measures
    this.pairs = scene.pairs.map(([a, b], id) => ({
      id, a, b, name: `${scene.objects[a].name} – ${scene.objects[b].name}`,
      margins: scene.objects[a].margin + scene.objects[b].margin, zones: [],
    }));
    for (const zone of scene.zones) for (const pair of zone.pairs) this.pairs[pair].zones.push(zone);
  }

  takeReport(report, timeNs) {
    this.report = report;
    this.reportNs = timeNs;
    this.lateObjects = new Map();
    this.meant = new Set((report.contacts ?? []).filter(({ status }) => status === ALLOWED).map(({ pair }) => pair));
    for (const pair of report.pairs) if (!isKnown(pair)) this.noteLate(pair);
    if (this.measured) report.pairs.push(this.measured);
    this.history.take(report, this.minimum(), this.scaling, timeNs);
  }

  takeSeparation(separation) {
    this.separation = separation;
    this.limiting = new Set((separation.stops ?? []).filter(({ validity, scaling }) => validity > 0 && scaling < 1).map(({ pair }) => pair));
  }

  // The pair of these two objects if reports have it.
  published(a, b) {
    return this.report?.pairs.find(({ pair }) => pair !== this.measuredId && [this.pairs[pair].a, this.pairs[pair].b].sort().join() === [a, b].sort().join())?.pair;
  }
  // From now on `measuredId` is the pair of these two objects, as far as setMeasured() says; without objects, it is no
  // pair any more.
  measure(a, b) {
    this.setMeasured(undefined);
    if (a === undefined) return;
    const name = `${this.scene.objects[a].name} – ${this.scene.objects[b].name}`;
    this.pairs[this.measuredId] = { id: this.measuredId, a, b, name, margins: 0, zones: [] };
    this.scene.pairs[this.measuredId] = [a, b, 0];
    this.history.renew(this.measuredId);
  }
  // `pair` has the members of a report's pairs.
  setMeasured(pair) {
    this.measured = pair && { ...pair, pair: this.measuredId };
    if (!this.report) return;
    this.report.pairs = this.report.pairs.filter((each) => each.pair !== this.measuredId);
    if (pair) this.report.pairs.push(this.measured);
  }

  // The least speed scaling of all zones and of robots that state how they stop; undefined where none has one.
  get scaling() {
    const limits = [...(this.separation?.zones ?? []), ...(this.separation?.stops ?? [])];
    return limits.length ? Math.min(...limits.map(({ scaling }) => scaling)) : undefined;
  }

  // Notes which object of a pair is the cause: the one whose pose is older, or is unknown.
  noteLate({ pair, age_a_ns, age_b_ns, status }) {
    const { a, b } = this.pairs[pair];
    const older = (x, y) => x < 0 || (y >= 0 && x > y);
    const [object, age] = older(age_a_ns, age_b_ns) ? [a, age_a_ns] : [b, age_b_ns];
    if (!this.scene.objects[object].fixed) this.lateObjects.set(object, { age, status });
  }

  takeHealth(health, timeNs) {
    const before = this.health;
    const since = (timeNs - this.healthNs) * 1e-9;
    const follows = before?.daemon === health.daemon && since >= 0 && since < HEALTH_AGAIN_S;
    if (follows && health.overruns > before.overruns) {
      this.overrun = { count: health.overruns - before.overruns, ns: timeNs, us: health.tick_second_max_us };
    }
    this.health = health;
    this.healthNs = timeNs;
    this.history.takeHealth(health, timeNs);
  }

  // The least pair; undefined while it is unknown or stale.
  minimum() {
    const { report } = this;
    return report && report.minimum_known && isKnown(report.minimum) ? report.minimum : undefined;
  }

  // "inside", "leaving" or "outside" its zones, "inside" too where bodies overlap without an allowed contact or a robot would not stop clear, "free" of any, "meant" as an allowed contact, or "lost".
  levelOf(pair) {
    if (!isKnown(pair)) return "lost";
    if (this.meant.has(pair.pair)) return "meant";
    if (pair.status === OVERLAPPING || pair.upper < 0 || this.limiting.has(pair.pair)) return "inside";
    const { zones, margins } = this.pairs[pair.pair];
    const clearance = pair.lower - margins;
    if (zones.some(({ enter_below }) => clearance < enter_below)) return "inside";
    if (zones.some(({ leave_above }) => clearance < leave_above)) return "leaving";
    return zones.length ? "outside" : "free";
  }

  secondsSilent() {
    return this.reportNs ? (this.timeNs - this.reportNs) * 1e-9 : 0;
  }

  zoneStates() {
    return this.scene.zones.map((zone, id) => {
      const state = this.zones.get(id);
      const cause = state?.active ? this.causeOf(state) : "";
      return { id, zone, active: state?.active, known: state !== undefined, cause, pair: this.pairs[state?.pair]?.name, cycle: state?.since_cycle };
    });
  }
  // "by distance", "poses of hand are late": the server's text for the cause of an active zone.
  causeOf({ cause, cause_object }) {
    const { name, placed_by = "poses" } = this.scene.objects[cause_object] ?? {};
    return this.scene.zone_causes[placed_by][cause]?.replace("{}", () => name) ?? "";
  }
  // A word for what places the objects of the cell.
  get inputs() {
    const moving = this.scene.objects.filter(({ fixed, placed_by }) => !fixed && placed_by !== "frames"), byJoints = moving.filter(({ placed_by }) => placed_by === "joint_states");
    return byJoints.length === 0 ? "poses" : byJoints.length === moving.length ? "joint states" : "poses or joint states";
  }

  // The alarms: [{level: "lost" | "alarm" | "near", text}], the worst first. `frozen`: the view is not the present
  // state.
  alarms() {
    const found = [];
    if (!this.connected) found.push({ level: "alarm", frozen: true, text: "Connection to clearance-view lost" });
    for (const [id, { level, text }] of this.statuses) {
      found.push({ level: level > 1 ? "alarm" : "near", frozen: !LIVE.includes(id), text });
    }
    const silent = this.secondsSilent();
    if (this.connected && !found.some(({ frozen }) => frozen) && silent > SILENT_S) {
      found.push({ level: "alarm", frozen: true, text: `No report for ${silent.toFixed(1)} s` });
    }
    return found.concat(this.doubts());
  }

  doubts() {
    const found = [];
    const { report } = this;
    if (report && !report.minimum_known) found.push({ level: "lost", text: "Least distance not known: no pair has been evaluated" });
    if (report && report.stale + report.unknown > 0) {
      const names = [...(this.lateObjects ?? [])].slice(0, 4).map(([object, { age: ns }]) =>
        `${this.scene.objects[object].name} ${age(ns)}${ns < 0 ? "" : " old"}`);
      found.push({ level: "lost", text: `${counted(report.stale, "pair")} stale, ${report.unknown} unknown${names.length ? `: ${names.join(", ")}` : ""}` });
    }
    if (this.overrun && Math.abs(this.timeNs - this.overrun.ns) * 1e-9 < TOLD_FOR_S) {
      found.push({ level: "near", text: `${counted(this.overrun.count, "overrun")} in the last second, longest tick ${(this.overrun.us / 1000).toFixed(2)} ms` });
    }
    return found;
  }
}
