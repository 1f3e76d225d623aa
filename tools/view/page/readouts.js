// The header, the alarm below it and the health: readable from across the cell.
import { age, counted, micro, milliseconds, mm, put } from "./format.js";
import { COLOUR } from "./pair_lines.js";
import { drawZones } from "./zone_chips.js";

const element = (id) => document.getElementById(id);

function drawMinimum(state, frozen) {
  const box = element("minimum"), value = element("minimum-value"), minimum = state.minimum();
  const level = minimum ? state.levelOf(minimum) : "lost";
  box.className = `minimum ${{ inside: "alarm", leaving: "near", lost: "unknown" }[level] ?? ""}`;
  box.dataset.cycle = state.report?.cycle ?? "";
  box.dataset.distance = minimum && !frozen ? minimum.distance : "";
  if (!minimum) {
    put(value, state.report ? "not known" : "–");
    put(element("minimum-pair"), state.report ? `${state.inputs} are late or have never come` : "no report yet");
    put(element("minimum-bounds"), state.report ? `every pair at least ${mm(state.report.lower_all)} mm` : "");
    return;
  }
  if (value.lastChild?.nodeName !== "SMALL") value.innerHTML = "<span></span><small>mm</small>";
  put(value.firstChild, mm(minimum.distance));
  put(element("minimum-pair"), `${frozen ? "was " : ""}${state.pairs[minimum.pair].name}`);
  element("minimum").title = `${element("minimum-pair").textContent}\n${element("minimum-bounds").textContent}`;
  put(element("minimum-bounds"), `[${mm(minimum.lower, 3)}, ${mm(minimum.upper, 3)}]  ${state.report.minimum_certified ? "certified" : "NOT certified"}`);
}

function drawAlarm(alarms) {
  const box = element("alarm"), key = JSON.stringify(alarms);
  if (box.dataset.key === key) return;
  box.dataset.key = key;
  box.hidden = alarms.length === 0;
  box.className = alarms[0]?.level ?? "";
  box.replaceChildren(...alarms.map(({ text }) => Object.assign(document.createElement("span"), { textContent: text })));
}

function drawState(state, frozen, playing) {
  const chip = element("state");
  const [kind, text] = !state.connected ? ["alarm", "not connected"] : state.timeline ? ["replay", playing ? "recording, playing" : "recording"]
    : frozen ? ["alarm", "not live"] : state.report ? ["live", `live  ${state.scene.rate_hz.toFixed(0)} Hz`] : ["", "waiting"];
  chip.className = `chip ${kind}`;
  put(chip, text);
  element("scene").classList.toggle("frozen", frozen);
  element("scene").classList.toggle("doubtful", !frozen && state.doubts().some(({ level }) => level === "lost"));
}

// Rows of the health: [term, text, is bad].
function healthRows({ report, health }) {
  const rows = [];
  if (report) {
    rows.push(["Pairs", `${report.pairs_total}: ${report.evaluated} evaluated, ${report.carried} carried, ${report.stale} stale, ${report.unknown} unknown`, report.stale + report.unknown > 0]);
    rows.push(["Cycle", `${report.cycle}, refreshed within ${counted(report.oldest_evaluation_cycles, "tick")}`]);
    if (report.newest_pose_ns) {
      const since = (ns) => age(report.now_ns + report.clock_offset_ns - ns);
      rows.push(["Inputs", `${since(report.newest_pose_ns)} to ${since(report.oldest_pose_ns)} old`]);
    }
  }
  if (!health) return rows;
  rows.push(["Tick", `p50 ${micro(health.tick_p50_us)}, p99.9 ${micro(health.tick_p999_us)}, max ${micro(health.tick_max_us)}, last second ${micro(health.tick_second_max_us)}`]);
  rows.push(["Wake-up", `p50 ${micro(health.wakeup_p50_us)}, p99.9 ${micro(health.wakeup_p999_us)}, max ${micro(health.wakeup_max_us)}`]);
  rows.push(["Response", `p50 ${micro(health.response_p50_us)}, p99.9 ${micro(health.response_p999_us)}, max ${micro(health.response_max_us)}${health.responses?.length ? `, slowest: ${health.responses[0].input}` : ""}`, health.late_responses > 0]);
  rows.push(["Overruns", `${health.overruns}, ${counted(health.skipped_cycles, "cycle")} skipped, ${counted(health.dropped_reports, "report")} dropped`, health.overruns + health.skipped_cycles + health.dropped_reports > 0]);
  for (const { source, batches, lost_batches } of health.sources) rows.push(["Source", `${source}: ${counted(batches, "batch", "batches")}, ${lost_batches} lost`, lost_batches > 0]);
  for (const { name, age_ns, contradicted } of health.inputs.filter(({ stale }) => stale).slice(0, 6)) {
    rows.push(["Late", `${name}: ${age(age_ns)}${contradicted ? ", contradicted" : ""}`, true]);
  }
  for (const { object, cause, count, last } of health.rejected.slice(0, 6))
    rows.push(["Refused", `${object}: ${cause} (${count}${last ? `, last ${last}` : ""})`, true]);
  if (health.recording) rows.push(["Recording", health.recording]);
  return rows;
}

function drawHealth(state) {
  const rows = healthRows(state), key = JSON.stringify(rows);
  if (element("health").dataset.key === key) return;
  element("health").dataset.key = key;
  element("health").replaceChildren(...rows.flatMap(([term, text, bad]) => [
    Object.assign(document.createElement("dt"), { textContent: term }),
    Object.assign(document.createElement("dd"), { textContent: text, className: bad ? "bad" : "" }),
  ]));
}

// Colours of pairs; those of zones only where the cell has zones.
export function drawLegend({ zones }) {
  const ofZones = ["inside", "leaving", "outside"];
  const meanings = { inside: "in a zone", leaving: "leaving it", outside: "outside its zones", free: "in no zone", meant: "allowed contact", lost: "late or unknown" };
  element("legend").replaceChildren(...Object.entries(meanings).filter(([level]) => zones.length || !ofZones.includes(level)).map(([level, text]) => {
    const entry = document.createElement("span"), mark = document.createElement("i");
    mark.style.background = `var(${COLOUR[level]})`;
    entry.append(mark, text);
    return entry;
  }));
}

// Returns whether the view is frozen. Texts change only as often as a person can read: in a slow browser, layout costs
// more than the scene.
const AGAIN_MS = 100;
let drawnMs = 0, healthDrawnMs = 0, frozen = false;
export function drawReadouts(state, playing, nowMs) {
  if (nowMs - drawnMs < AGAIN_MS) return frozen;
  drawnMs = nowMs;
  const alarms = state.alarms();
  frozen = alarms.some((alarm) => alarm.frozen);
  drawAlarm(alarms);
  drawState(state, frozen, playing);
  drawMinimum(state, frozen);
  drawZones(state, frozen);
  if (nowMs - healthDrawnMs > 200) {
    healthDrawnMs = nowMs;
    drawHealth(state);
  }
  return frozen;
}
