// The table as a file: comma-separated values (RFC 4180) in SI units, with every figure of the report.
import { STATUS } from "./format.js";
import { VALIDITY } from "./separation_rows.js";

const seconds = (ns) => (ns < 0 ? NaN : ns * 1e-9);
const point = (name, of) => ["x", "y", "z"].map((axis) => [`${name}_${axis}_m`, (row) => of(row)[axis]]);

const COLUMNS = [
  ["time_s", ({ report }) => (Number(report.now_ns) + Number(report.clock_offset_ns)) * 1e-9], ["cycle", ({ report }) => report.cycle],
  ["object_a", ({ names }) => names[0]], ["object_b", ({ names }) => names[1]],
  ["status", ({ pair }) => STATUS[pair.status]],
  ["distance_m", ({ pair }) => pair.distance], ["lower_m", ({ pair }) => pair.lower], ["upper_m", ({ pair }) => pair.upper],
  ["swept_lower_m", ({ pair }) => pair.swept_lower], ["model_error_m", ({ pair }) => pair.model_error], ["stop_lower_m", ({ pair }) => pair.stop_lower],
  ["closing_speed_m_s", ({ pair }) => pair.closing_speed], ["time_to_contact_s", ({ pair }) => pair.time_to_contact],
  ["age_a_s", ({ pair }) => seconds(pair.age_a_ns)], ["age_b_s", ({ pair }) => seconds(pair.age_b_ns)],
  ...point("point_a", ({ pair }) => pair.witness_a), ...point("point_b", ({ pair }) => pair.witness_b),
];

// Columns of a robot that states how it stops, the same in all rows.
const OF_STOP = [
  ["validity", ({ validity }) => VALIDITY[validity]], ["scaling", ({ scaling }) => scaling], ["clearance_m", ({ clearance }) => clearance],
  ["pair", ({ pair }, pairs) => pairs[pair].name], ["share", ({ share }) => share], ["time_s", ({ time }) => time],
];

// Figures that are not known are empty.
function field(value) {
  if (typeof value === "number") return Number.isNaN(value) ? "" : value === Infinity ? "inf" : value === -Infinity ? "-inf" : String(value);
  const text = String(value);
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}

// `pairs`: those of the report that are listed, in their order.
export function tableCsv({ report, separation, pairs: known, scene }, pairs) {
  const stops = (separation?.stops ?? []).flatMap((stop) => OF_STOP.map(([name, value]) => [`${scene.robots[stop.robot].name}/stop_${name}`, () => value(stop, known)]));
  const columns = [...COLUMNS, ...stops];
  const rows = pairs.map((pair) => ({ report, pair, names: [known[pair.pair].a, known[pair.pair].b].map((object) => scene.objects[object].name) }));
  const lines = [columns.map(([name]) => field(name)), ...rows.map((row) => columns.map(([, value]) => field(value(row))))];
  return lines.map((line) => `${line.join(",")}\r\n`).join("");
}

export function save(text, name, type) {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
