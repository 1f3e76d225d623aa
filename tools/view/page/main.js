// clearance-view's page: joins the server's messages, the view and the controls.
import { addressOf, asked } from "./address.js";
import { verdictOf } from "./asked_path.js";
import { CellState } from "./cell_state.js";
import { Connection } from "./connection.js";
import { isKnown } from "./format.js";
import { HiddenObjects } from "./hidden_objects.js";
import { onKeys } from "./keys.js";
import { Measuring } from "./measuring.js";
import { PairTable } from "./pair_table.js";
import { savePicture } from "./picture.js";
import { Plots } from "./plots.js";
import { drawLegend, drawReadouts } from "./readouts.js";
import { ContactRows } from "./contact_rows.js";
import { SeparationRows } from "./separation_rows.js";
import { SEEN_MODES } from "./seen.js";
import { SensorRows } from "./sensor_rows.js";
import { SceneView } from "./scene_view.js";
import { save, tableCsv } from "./table_csv.js";
import { Timeline } from "./timeline.js";
import { MODES } from "./visuals.js";

const element = (id) => document.getElementById(id);
const json = async (path) => (await fetch(path)).json();

const [scene, timeline] = await Promise.all([json("/scene.json"), json("/timeline.json")]);
const state = new CellState(scene, timeline);
const chosen = new Set();
document.title = `${scene.name} – Clearance`;
element("cell-name").textContent = scene.name;

// ---- Theme

const dark = matchMedia("(prefers-color-scheme: dark)");
let theme = asked.theme;
function applyTheme() {
  document.documentElement.dataset.theme = theme ?? (dark.matches ? "dark" : "light");
}
applyTheme();

// ---- The parts of the page

const view = new SceneView(scene, { pairChosen: (pair) => choose(pair, false), pairLookedAt: look, picksBodies: () => measuring.isOn, objectChosen: (object) => (measuring.isOn ? measuring.take(object) : chooseObject(object)) });
const table = new PairTable(choose, look, changed);
const separations = new SeparationRows(choose);
const contacts = new ContactRows(choose, chooseObject);
const sensors = new SensorRows(scene, view.seen, (object) => chooseObject(object));
const plots = new Plots();
const measuring = new Measuring(state, {
  marked: (objects) => mark(objects),
  chosen: (pair) => chosen.has(pair) || choose(pair, false),
  released: (pair) => chosen.delete(pair) && selected(),
  changed: () => ++view.changes,
});
const hidden = new HiddenObjects(scene, (objects) => {
  view.bodies.turnOff(objects);
  ++view.changes;
  changed();
});
const topics = scene.topics;
const connection = new Connection(`ws://${location.host}/`, [topics.distances, topics.zones, topics.health, topics.separation, "/tf", ...(scene.sensors.length ? ["/clearance/seen"] : [])], {
  open: () => {
    state.connected = true;
    if (asked.time !== undefined && timeline) connection.set("playback.time", asked.time);
  },
  closed: () => (state.connected = false),
  time: (ns) => (state.timeNs = ns),
  status: (id, level, text) => (text ? state.statuses.set(id, { level, text }) : state.statuses.delete(id)),
  parameters: (values) => {
    const revision = values["scene.revision"];
    if (revision !== undefined && revision !== scene.revision) return changeCell();
    contacts.attached = values["scene.attached"] ?? contacts.attached;
    if (values["asked.motion"] !== undefined) showAsked(values["asked.motion"]);
    track?.parameters(values);
  },
  message: (topic, value, ns) => {
    if (isOfAnotherCell(value)) return;
    if (topic === "/tf") view.moved(value);
    else if (topic === "/clearance/seen") view.takeSeen(value, ns);
    else if (topic === topics.distances) state.takeReport(value, ns);
    else if (topic === topics.zones) state.zones.set(value.zone, value);
    else if (topic === topics.separation) state.takeSeparation(value);
    else if (topic === topics.health) state.takeHealth(value, ns);
  },
});
const track = timeline && new Timeline(timeline, scene.zones, (name, value) => connection.set(name, value));
drawLegend(scene);

// Ids of a report of another cell mean other objects. A recording may be shown with a cell that was edited since.
function isOfAnotherCell({ scene_revision, pairs }) {
  if (!pairs || scene_revision === undefined || Number(scene_revision) === Number(scene.revision)) return false;
  return !timeline || pairs.some(({ pair }) => !state.pairs[pair]);
}

// ---- The motion that a client asked about

let askedAs; // client and request of the motion that is shown, or was closed
function showAsked(motion) {
  const as = motion && `${motion.client} ${motion.request}`;
  if (as === askedAs) return;
  askedAs = as;
  drawAsked(motion);
}
function drawAsked(motion) {
  view.askedPath.show(motion);
  ++view.changes;
  element("asked").hidden = !motion;
  if (!motion) return;
  const { level, text } = verdictOf(motion);
  element("asked").textContent = text;
  element("asked").className = `notice ${level}`;
}
element("asked").onclick = () => drawAsked(null);

// ---- Selection

let marked = []; // objects, while they are chosen rather than pairs
// Chooses a pair, alone or, with `more`, in addition; a chosen pair is released.
function choose(pair, more) {
  const was = chosen.has(pair);
  if (!more) chosen.clear();
  if (was) chosen.delete(pair);
  else chosen.add(pair);
  selected();
  table.scrollTo(pair);
}
// Chooses the pair and brings it into view.
function look(pair) {
  if (!chosen.has(pair)) choose(pair, false);
  lookAtChosen();
}
// Without a chosen pair, at the least one.
function lookAtChosen() {
  const shown = state.report?.pairs.filter((each) => isKnown(each) && chosen.has(each.pair)) ?? [];
  const least = state.minimum();
  view.lookAt(shown.length || !least ? shown : [least]);
}
function chooseObject(object) {
  if (object === undefined) return clear();
  table.filter = scene.objects[object].name;
  mark([object]);
}
// Marks objects instead of pairs.
function mark(objects) {
  chosen.clear();
  selected();
  view.bodies.choose(objects);
  marked = objects;
  ++view.changes;
}
function clear() {
  measuring.clear();
  chosen.clear();
  table.filter = "";
  selected();
}
function selected() {
  marked = [];
  view.bodies.choose([...chosen].flatMap((id) => [state.pairs[id].a, state.pairs[id].b]));
  table.drawnMs = plots.drawnMs = 0;
  changed();
}

// ---- Address

const secondsIn = () => (timeline ? (state.timeNs - Number(timeline.begin_ns)) * 1e-9 : undefined);
const linked = () => [...chosen].filter((id) => id !== state.measuredId);
const pairName = (id) => `${scene.objects[state.pairs[id].a].name}~${scene.objects[state.pairs[id].b].name}`;
function address(withCamera) {
  return addressOf({
    time: secondsIn(), pairs: linked().map(pairName), hidden: hidden.names, filter: table.filter, sort: table.sorting, theme,
    camera: withCamera ? view.place : asked.camera, shells: view.shells.visible, stops: view.stopGhosts.visible, robots: view.visuals.mode, seen: view.seen.mode,
  });
}
// The cell is another one: the page is loaded anew, and looks from the same place if a person has chosen it. The server knows the time.
function changeCell() {
  const link = new URL(address(view.fitted && !view.follows), location.href);
  link.searchParams.delete("t");
  state.history.keep?.(linked());
  history.replaceState(null, "", link);
  location.reload();
}
function changed() {
  history.replaceState(null, "", address(false));
}
for (const name of asked.pairs) {
  const found = state.pairs.find(({ id }) => pairName(id) === name);
  if (found) chosen.add(found.id);
}
table.filter = asked.filter;
if (asked.sort) table.sorting = asked.sort;
view.bodies.choose([...chosen].flatMap((id) => [state.pairs[id].a, state.pairs[id].b]));
view.shells.visible = asked.shells;
view.stopGhosts.visible = asked.stops;
hidden.names = asked.hidden;
if (asked.camera) view.place = asked.camera;

// ---- Buttons and keys

function toast(text) {
  element("toast").textContent = text;
  element("toast").hidden = false;
  setTimeout(() => (element("toast").hidden = true), Math.max(1800, 60 * text.length));
}
// Shows the bodies of robots, their looks, or both.
async function showRobots(mode) {
  if (!scene.has_robots) return;
  element("visuals").setAttribute("aria-pressed", mode !== "bodies");
  element("visuals").textContent = { bodies: "Bodies", looks: "Looks", both: "Both" }[mode];
  const isFirst = !view.visuals.loaded;
  const shown = view.visuals.show(mode);
  changed();
  await shown;
  ++view.changes;
  if (!isFirst) return;
  if (view.visuals.leftOut.length) toast(`Not drawn: ${view.visuals.leftOut.join("; ")}`);
  else if (!view.visuals.children.length) toast("The URDF has no visual shapes");
}
const actions = {
  fit: () => view.fit(),
  look: (side) => view.fit(side),
  lookAtChosen,
  theme: () => {
    theme = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    applyTheme();
    view.retheme();
    changed();
  },
  shells: () => {
    view.shells.visible = !view.shells.visible;
    element("shells").setAttribute("aria-pressed", view.shells.visible);
    changed();
  },
  stops: () => {
    view.stopGhosts.visible = !view.stopGhosts.visible;
    ++view.changes;
    element("stops").setAttribute("aria-pressed", view.stopGhosts.visible);
    changed();
  },
  visuals: () => showRobots(MODES[(MODES.indexOf(view.visuals.mode) + 1) % MODES.length]),
  seen: () => {
    if (!scene.sensors.length) return;
    view.seen.mode = SEEN_MODES[(SEEN_MODES.indexOf(view.seen.mode) + 1) % SEEN_MODES.length];
    ++view.seen.changes;
    element("seen").setAttribute("aria-pressed", view.seen.mode !== "nothing");
    toast(`Drawn of what cameras see: ${{ all: "points and shells" }[view.seen.mode] ?? view.seen.mode}`);
    changed();
  },
  objects: () => hidden.toggleList(),
  hide: () => {
    for (const object of marked.length ? marked : [...chosen].flatMap((id) => [state.pairs[id].a, state.pairs[id].b])) hidden.toggle(object);
  },
  measure: () => measuring.toggle(),
  csv: () => {
    if (state.report) save(tableCsv(state, table.listed(state).map(({ pair }) => pair)), `${scene.name}-${state.report.cycle}.csv`, "text/csv");
  },
  share: async () => {
    const link = address(true);
    history.replaceState(null, "", link);
    await navigator.clipboard?.writeText(link).catch(() => {});
    toast("The link to this view is in the address bar, and copied");
  },
  picture: () => {
    const cycle = state.report?.cycle ?? 0;
    const [value, pair] = [element("minimum-value").textContent, element("minimum-pair").textContent];
    const when = timeline ? `${secondsIn().toFixed(3)} s` : new Date(state.timeNs * 1e-6).toISOString();
    view.redraw();
    savePicture(element("view"), element("labels"), `${scene.name}, cycle ${cycle}, ${when}: ${value}, ${pair}`, `${scene.name}-${cycle}.png`);
  },
  filter: () => element("filter").focus(),
  clear,
  row: (by) => {
    const next = table.neighbour([...chosen].at(-1), by);
    if (next !== undefined && !chosen.has(next)) choose(next, false);
  },
  help: () => (element("keys").open ? element("keys").close() : element("keys").showModal()),
};
for (const id of ["fit", "shells", "visuals", "theme", "share", "picture", "help", "measure", "csv", "seen", "stops"]) element(id).onclick = actions[id];
element("object-button").onclick = actions.objects;
element("look").onclick = lookAtChosen;
element("visuals").hidden = !scene.has_robots;
element("seen").hidden = !scene.sensors.length;
element("stops").hidden = !view.stopGhosts.children.length;
element("stops").setAttribute("aria-pressed", view.stopGhosts.visible);
element("shells").hidden = element("zones").hidden = !scene.zones.length;
element("shells").setAttribute("aria-pressed", view.shells.visible);
dark.addEventListener("change", () => {
  applyTheme();
  view.retheme();
});
onKeys(actions, track);
if (SEEN_MODES.includes(asked.seen)) view.seen.mode = asked.seen;
if (MODES.includes(asked.robots)) showRobots(asked.robots);

// ---- Frames

let firstMs, drawnReport, frames = 0;
const times = [];
function frame(nowMs) {
  requestAnimationFrame(frame);
  connection.handWaiting();
  const frozen = drawReadouts(state, track?.playing, nowMs);
  view.draw(state, chosen, frozen, nowMs);
  table.draw(state, chosen, nowMs);
  contacts.draw(state, frozen, nowMs);
  separations.draw(state, frozen, nowMs);
  sensors.draw(state, frozen, nowMs);
  plots.draw(state, chosen, nowMs);
  measuring.draw(state, nowMs);
  if (track && state.timeNs) track.draw(secondsIn());
  if (state.report && view.fitted && view.isReady) firstMs ??= nowMs;
  drawnReport = state.reportNs;
  ++frames;
  times.push(nowMs);
  if (times.length > 120) times.shift();
}
requestAnimationFrame(frame);

// Since when the recording has stood at a time, with a report, for a caller of isAt().
let stood;
// Tables and plots are drawn a few times a second. The scene is drawn beside the page, and is finished when a pixel can
// be read.
function isDrawn(time) {
  stood ??= { frame: frames, ms: performance.now(), time, report: drawnReport };
  if (stood.finished) return frames > stood.finished + 1;
  if (frames > stood.frame + 2 && performance.now() > stood.ms + 300) {
    view.finish();
    stood.finished = frames;
  }
  return false;
}

// For tests and pictures: the state of the page.
window.clearance = {
  state, view, connection, plots, measuring,
  csv: () => tableCsv(state, table.listed(state).map(({ pair }) => pair)),
  stands: () => ({ at: secondsIn(), report: drawnReport, time: state.timeNs, ready: view.isReady, frames, connected: state.connected }),
  shownFor: () => (firstMs === undefined ? -1 : (performance.now() - firstMs) / 1000),
  // True when the recording stands at this time, s, and has been drawn there with tables and plots.
  isAt: (time) => {
    const there = drawnReport !== undefined && Math.abs(secondsIn() - Math.min(time, timeline.duration)) < 1e-3 &&
      Math.abs(drawnReport - state.timeNs) < 1e9 && view.isReady && !state.history.isAsking;
    if (!there || stood?.time !== time || stood.report !== drawnReport) stood = undefined;
    return there && isDrawn(time);
  },
  framesPerSecond: () => (times.length < 2 ? 0 : (1000 * (times.length - 1)) / (times.at(-1) - times[0])),
};
