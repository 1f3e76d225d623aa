// The published pairs as a table: sorted, filtered, chosen by a click. It is drawn a few times a second, with no more
// rows than a person reads.
import { contact, isKnown, milliseconds, mm, put, signed, STATUS } from "./format.js";
import { COLOUR } from "./pair_lines.js";

const MOST_ROWS = 250;
const AGAIN_MS = 200;

const KEYS = {
  name: ({ name }) => name,
  distance: ({ pair }) => (isKnown(pair) ? pair.distance : -Infinity),
  lower: ({ pair }) => pair.lower,
  speed: ({ pair }) => (Number.isNaN(pair.closing_speed) ? Infinity : -pair.closing_speed),
  contact: ({ pair }) => (Number.isNaN(pair.time_to_contact) ? -Infinity : pair.time_to_contact),
  age: ({ pair }) => -ageOf(pair),
};
const ageOf = ({ age_a_ns, age_b_ns }) => (Math.min(age_a_ns, age_b_ns) < 0 ? Infinity : Math.max(age_a_ns, age_b_ns));

export class PairTable {
  // `choose(pair, more)` is called for a clicked row, `more`: with Ctrl or Shift; `look(pair)` for two clicks.
  constructor(choose, look, changed) {
    this.body = document.querySelector("#pair-table tbody");
    this.heads = [...document.querySelectorAll("#pair-table th")];
    this.input = document.getElementById("filter");
    this.count = document.getElementById("pair-count");
    this.choose = choose;
    this.look = look;
    this.rows = [];
    this.drawnMs = 0;
    this.sortBy("lower", false);
    for (const head of this.heads) {
      head.tabIndex = 0;
      head.onclick = () => {
        this.sortBy(head.dataset.key, this.key === head.dataset.key && !this.down);
        changed();
      };
      head.onkeydown = ({ key }) => key === "Enter" && head.onclick();
    }
    this.input.oninput = () => {
      this.drawnMs = 0;
      changed();
    };
  }

  sortBy(key, down) {
    if (!KEYS[key]) return;
    this.key = key;
    this.down = down;
    this.drawnMs = 0;
    for (const head of this.heads) {
      const isSorted = head.dataset.key === key;
      head.classList.toggle("sorted", isSorted);
      head.classList.toggle("down", isSorted && down);
      head.setAttribute("aria-sort", !isSorted ? "none" : down ? "descending" : "ascending");
    }
  }

  // For addresses: "lower", or "-lower" for descending order.
  get sorting() {
    return `${this.down ? "-" : ""}${this.key}`;
  }
  set sorting(text) {
    this.sortBy(text.replace("-", ""), text.startsWith("-"));
  }

  get filter() {
    return this.input.value.trim();
  }
  set filter(text) {
    this.input.value = text;
    this.drawnMs = 0;
  }

  listed(state) {
    const words = this.filter.toLowerCase().split(/\s+/).filter(Boolean);
    const value = KEYS[this.key];
    const all = state.report.pairs.map((pair) => ({ pair, name: state.pairs[pair.pair].name }))
      .filter(({ name }) => words.every((word) => name.toLowerCase().includes(word)))
      .map((row) => [value(row), row]);
    const sign = this.down ? -1 : 1;
    all.sort(([a], [b]) => sign * (a < b ? -1 : a > b ? 1 : 0));
    return all.map(([, row]) => row);
  }

  draw(state, chosen, nowMs) {
    if (!state.report || nowMs - this.drawnMs < AGAIN_MS) return;
    this.drawnMs = nowMs;
    const listed = this.listed(state);
    put(this.count, `${listed.length} of ${state.report.pairs.length}${state.report.pairs_total > state.report.pairs.length ? `, ${state.report.pairs_total} watched` : ""}`);
    this.order = listed.map(({ pair }) => pair.pair);
    listed.slice(0, MOST_ROWS).forEach((row, i) => this.fill((this.rows[i] ??= this.makeRow()), row, state, chosen));
    this.rows.forEach((row, i) => (row.hidden = i >= listed.length));
  }

  makeRow() {
    const row = this.body.insertRow();
    for (let i = 0; i < 6; ++i) row.insertCell();
    row.onclick = (event) => this.choose(Number(row.dataset.pair), event.ctrlKey || event.metaKey || event.shiftKey);
    row.ondblclick = () => this.look(Number(row.dataset.pair));
    return row;
  }

  fill(row, { pair, name }, state, chosen) {
    const known = isKnown(pair);
    if (row.dataset.pair !== String(pair.pair)) row.dataset.pair = pair.pair;
    row.className = `${chosen.has(pair.pair) ? "chosen" : ""} ${known ? "" : "lost"}`;
    row.style.setProperty("--mark", `var(${COLOUR[state.levelOf(pair)]})`);
    row.title = `${name}: ${STATUS[pair.status]}, bounds ${pair.lower} to ${pair.upper} m${pair.model_error > 0 ? ` (stated errors: ${mm(pair.model_error, 1)})` : ""}, refreshed ${pair.refresh_age_cycles} ticks ago`;
    const age = ageOf(pair);
    [name, known ? mm(pair.distance) : STATUS[pair.status], mm(pair.lower, known ? 1 : 0), signed(pair.closing_speed, 2), contact(pair.time_to_contact),
      age === Infinity ? "never" : milliseconds(age)].forEach((text, i) => put(row.cells[i], text));
  }

  // The pair in the row `by` rows after the given one.
  neighbour(pair, by) {
    const order = this.order ?? [];
    const at = order.indexOf(pair);
    return order[Math.min(order.length - 1, Math.max(0, at < 0 ? 0 : at + by))];
  }
  scrollTo(pair) {
    this.rows.find(({ dataset, hidden }) => !hidden && Number(dataset.pair) === pair)?.scrollIntoView({ block: "nearest" });
  }
}
