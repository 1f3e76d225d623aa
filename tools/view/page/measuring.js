// Measures between two bodies that a person clicks. Of a published pair, the reports have the distance. Of any other, the
// server computes it at the poses that it shows, and the page treats it as one more pair.
import { put } from "./format.js";

const AGAIN_MS = 150;
const UNKNOWN = 6; // PairStatus of monitor/interface/report.hpp

const element = (id) => document.getElementById(id);
const orElse = (value, without) => value ?? without;

export class Measuring {
  // Callbacks: marked(objects) for the objects that are clicked so far, chosen(pair), released(pair), changed().
  constructor(state, on) {
    this.state = state;
    this.on = on;
    this.objects = [];
    this.isOn = false;
  }

  toggle() {
    this.clear();
    this.isOn = !this.wasOn;
    this.show();
  }
  // Ends it, without a trace.
  clear() {
    this.wasOn = this.isOn;
    this.isOn = false;
    this.objects = [];
    if (this.state.measured) this.on.released(this.state.measuredId);
    this.state.measure();
    this.on.changed();
    this.show();
  }

  // A third body begins anew.
  take(object) {
    if (object === undefined || this.objects.at(-1) === object) return;
    if (this.objects.length === 2) {
      if (this.state.measured) this.on.released(this.state.measuredId);
      this.objects = [];
    }
    this.objects.push(object);
    if (this.objects.length < 2) this.on.marked(this.objects);
    else this.begin(...this.objects);
    this.show();
  }
  begin(a, b) {
    const published = this.state.published(a, b);
    this.isPublished = published !== undefined;
    this.state.measure(...(this.isPublished ? [] : [a, b]));
    if (this.isPublished) return this.on.chosen(published);
    this.state.setMeasured(this.answer({}));
    this.on.chosen(this.state.measuredId);
    this.askedNs = undefined;
  }

  // The members that a report's pair has. JSON has no infinities: null is not known.
  answer({ status, distance, lower, upper, witness_a, witness_b, age_a_ns, age_b_ns }) {
    const point = (at) => ({ x: orElse(at?.x, NaN), y: orElse(at?.y, NaN), z: orElse(at?.z, NaN) });
    return {
      status: orElse(status, UNKNOWN), distance: orElse(distance, NaN), lower: orElse(lower, -Infinity), upper: orElse(upper, Infinity),
      witness_a: point(witness_a), witness_b: point(witness_b), age_a_ns: orElse(age_a_ns, -1), age_b_ns: orElse(age_b_ns, -1),
      closing_speed: NaN, time_to_contact: NaN, refresh_age_cycles: 0,
    };
  }

  // Asks again for a newer report, one request at a time.
  async draw({ reportNs }, nowMs) {
    if (this.objects.length < 2 || this.isPublished || this.isAsking || reportNs === this.askedNs || nowMs - this.askedMs < AGAIN_MS) return;
    [this.isAsking, this.askedNs, this.askedMs] = [true, reportNs, nowMs];
    const [a, b] = this.objects, isStill = () => this.objects[0] === a && this.objects[1] === b;
    const found = await fetch(`/distance.json?a=${a}&b=${b}`).then((answer) => answer.json()).catch(() => ({}));
    this.isAsking = false;
    if (!isStill()) return;
    this.state.setMeasured(this.answer(found));
    this.on.changed();
  }

  show() {
    const names = this.objects.map((object) => this.state.scene.objects[object].name);
    element("measure").setAttribute("aria-pressed", this.isOn);
    element("measure-hint").hidden = !this.isOn;
    put(element("measure-hint"), ["Click the first body", `From ${names[0]}: click the second body`,
      `${names.join(" to ")}: ${this.isPublished ? "a watched pair, from the reports" : "not a published pair; computed for this page at the poses shown"}`][names.length]);
  }
}
