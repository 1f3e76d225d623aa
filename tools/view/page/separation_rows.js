// Speed and separation monitoring, a row per zone that asks for it. It has the excess of the
// distance between a person and the robot over the protective separation distance S_p, and the
// robot's allowed speed. Below these, a row per robot that states how it stops.
import { mm, put } from "./format.js";

export const VALIDITY = ["not known", "by stated speeds", "measured", "absent"];
const AGAIN_MS = 125;
const FIGURES = 7; // cells of a row after the zone and the pair
const ABSENT = [["-", "-", "-", "1.00", "any", "-", "-"], ""];

const metresPerSecond = (value) => (value === Infinity ? "any" : Number.isFinite(value) ? value.toFixed(2) : "?");

// Returns [texts of the figures, class] of a zone; `pairs` are those of the message.
function figuresOf({ zone, pair, validity, remaining, speed_limit, scaling }, pairs) {
  const { clearance, protective_distance } = pairs.find((each) => each.zone === zone && each.pair === pair) ?? {};
  if (validity === 3) return ABSENT;
  if (validity === 0) return [["?", "?", "?", "0.00", "0.00", "-", "-"], "lost"];
  return [[mm(clearance, 0), mm(protective_distance, 0), mm(remaining, 0), scaling.toFixed(2), metresPerSecond(speed_limit), "-", "-"], scaling < 1 ? "alarm" : ""];
}

// The same of a robot that states how it stops: its limiting pair until it stands, `lower`, less the margin that zones
// state, the scaling, the share of its motion that is clear, and the time until it stands.
function figuresOfStop({ validity, clearance, scaling, share, time }, lower) {
  if (validity === 0) return [["?", "-", "?", "0.00", "-", "?", "?"], "lost"];
  if (validity === 3) return ABSENT;
  const figures = [Number.isFinite(lower) ? mm(lower, 0) : "-", "-", mm(clearance, 0), scaling.toFixed(2), "-", `${Math.floor(100 * share)} %`, time.toFixed(2)];
  return [figures, scaling < 1 ? "alarm" : ""];
}

export class SeparationRows {
  // `choose(pair)` is called for a clicked row. Hidden when no zone of the cell has a separation and no robot states how
  // it stops.
  constructor(choose) {
    this.choose = choose;
    this.section = document.getElementById("separation");
    this.body = this.section.querySelector("tbody");
  }

  draw({ separation, report, scene, pairs }, frozen, nowMs) {
    if (nowMs - this.drawnMs < AGAIN_MS) return;
    this.drawnMs = nowMs;
    this.section.hidden = !(separation?.zones.length || separation?.stops?.length);
    if (this.section.hidden) return;
    this.section.classList.toggle("old", frozen);
    const putRow = (i, name, { pair, validity }, [figures, kind]) => {
      const row = this.body.rows[i] ?? this.body.insertRow();
      while (row.cells.length < 1 + FIGURES) row.insertCell();
      row.className = kind;
      row.title = `${pairs[pair].name}: ${VALIDITY[validity]}`;
      row.onclick = () => this.choose(pair, false);
      [`${name}: ${pairs[pair].name}`, ...figures].forEach((text, cell) => put(row.cells[cell], text));
    };
    const { zones, stops = [] } = separation;
    zones.forEach((zone, i) => putRow(i, scene.zones[zone.zone].name, zone, figuresOf(zone, separation.pairs)));
    stops.forEach((stop, i) => {
      const lower = report?.pairs.find(({ pair }) => pair === stop.pair)?.stop_lower - pairs[stop.pair].margins;
      putRow(zones.length + i, `${scene.robots[stop.robot]?.name ?? "robot"} stops`, stop, figuresOfStop(stop, lower));
    });
  }
}
