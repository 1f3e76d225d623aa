// The contacts that the cell allows, a row per pair, and what is attached to what.
import { mm, put, seconds } from "./format.js";

// ContactStatus and ContactEnded of monitor/interface/report.hpp.
const STATUS = ["not known", "allowed", "too deep", "ended", "too late", "absent"];
const ENDED = ["", "by distance", "by time", "by cycle"];
const CLASS = ["lost", "", "alarm", "ended", "alarm", "ended"];
const AGAIN_MS = 125;

// The texts of a row: name, status, depth, who allowed it, since when, and its end.
function textsOf({ pair, status, ended, depth, since_cycle, since_ns, ended_cycle }, { name, depth: most, end, by }, pairName, nowNs) {
  const age = since_cycle > 0 && nowNs >= since_ns ? `, ${seconds((nowNs - since_ns) * 1e-9, 1)}` : "";
  const isOver = ENDED[ended] !== "";
  return [`${name}: ${pairName}`, STATUS[status] ?? `status ${status}`, `${mm(depth)} of ${mm(most)}`, by || "?", `cycle ${since_cycle}${age}`,
    isOver ? `ended ${ENDED[ended]} at cycle ${ended_cycle}` : end];
}

function fill(body, rows) {
  rows.forEach(({ texts, kind, title, click }, i) => {
    const row = body.rows[i] ?? body.insertRow();
    while (row.cells.length < texts.length) row.insertCell();
    row.className = kind;
    row.title = title;
    row.onclick = click;
    texts.forEach((text, cell) => put(row.cells[cell], text));
  });
  while (body.rows.length > rows.length) body.deleteRow(-1);
}

export class ContactRows {
  // `choose(pair)` is called for a clicked contact, `chooseObject(id)` for a clicked object.
  constructor(choose, chooseObject) {
    Object.assign(this, { choose, chooseObject, attached: [], drawnMs: -Infinity });
    this.contacts = document.getElementById("contacts");
    this.carried = document.getElementById("attached");
  }

  draw(state, frozen, nowMs) {
    if (nowMs - this.drawnMs < AGAIN_MS) return;
    this.drawnMs = nowMs;
    const { scene, report, pairs, timeline } = state, contacts = report?.contacts ?? [];
    this.contacts.hidden = contacts.length === 0;
    this.carried.hidden = this.attached.length === 0;
    for (const section of [this.contacts, this.carried]) section.classList.toggle("old", frozen);
    fill(this.contacts.querySelector("tbody"), contacts.map((contact) => {
      const terms = scene.contacts[contact.contact], { name } = pairs[contact.pair];
      const texts = textsOf(contact, terms, name, report.now_ns);
      return { texts, kind: CLASS[contact.status] ?? "lost", title: `${texts.join(", ")}${terms.reason ? `\n${terms.reason}` : ""}`, click: () => this.choose(contact.pair, false) };
    }));
    fill(this.carried.querySelector("tbody"), this.attached.map(({ object, carrier, cycle, seconds: s, or_before }) => {
      const at = timeline ? `${seconds(s)}, cycle ${cycle}` : cycle === 0 ? "the daemon's start" : `cycle ${cycle}`;
      const texts = [object, carrier, `${at}${or_before ? " or before" : ""}`];
      return { texts, kind: "", title: `${object} moves with ${carrier}, since ${texts[2]}`, click: () => this.chooseObject(scene.objects.findIndex(({ name }) => name === object)) };
    }));
  }
}
