// The sensors of the cell, a row each: what came of them, how old it is, and how thick the blind shell is.
import { milliseconds, mm, put } from "./format.js";

const AGAIN_MS = 250;

export class SensorRows {
  // `choose(object)` is called for a clicked sensor.
  constructor(scene, seen, choose) {
    Object.assign(this, { scene, seen, choose, drawnMs: -Infinity });
    this.section = document.getElementById("sensors");
    this.section.hidden = scene.sensors.length === 0;
  }

  textsOf(sensor, timeNs) {
    const status = this.seen.status[sensor], { ns } = this.seen.age(sensor, timeNs);
    const thickest = Object.entries(status?.shells ?? {}).sort(([, a], [, b]) => b - a)[0];
    const refused = (status?.refused ?? []).reduce((sum, { count }) => sum + count, 0);
    return [this.scene.sensors[sensor].name, status?.frames ? String(status.elements) : "none yet", ns < 0 ? "never" : milliseconds(ns),
      thickest ? `${mm(thickest[1], 0)} (${this.scene.objects[thickest[0]].name})` : "–", String(refused)];
  }

  draw(state, frozen, nowMs) {
    if (this.section.hidden || nowMs - this.drawnMs < AGAIN_MS) return;
    this.drawnMs = nowMs;
    this.section.classList.toggle("old", frozen);
    const body = this.section.querySelector("tbody");
    this.scene.sensors.forEach(({ object }, sensor) => {
      const row = body.rows[sensor] ?? body.insertRow(), texts = this.textsOf(sensor, state.timeNs);
      while (row.cells.length < texts.length) row.insertCell();
      texts.forEach((text, cell) => put(row.cells[cell], text));
      row.className = this.seen.age(sensor, state.timeNs).isLate ? "lost" : "";
      row.title = (this.seen.status[sensor]?.refused ?? []).map(({ cause, count }) => `refused ${count}: ${cause}`).join("\n");
      row.onclick = () => this.choose(object);
    });
  }
}
