// The zones in the header: a chip each with its state, and with why it is active. Those that do not fit into the
// row are counted.
import { mm } from "./format.js";

const element = (id) => document.getElementById(id);

// {kind, name, state, cause, title} of a zone; `frozen`: its state does not hold any more.
export function chipOf({ zone, active, known, cause, pair, cycle }, frozen) {
  const state = !known ? "not known" : active ? "ACTIVE" : "clear";
  const rule = `Entered below ${mm(zone.enter_below)} mm between ${zone.between.join(" and ")}, left above ${mm(zone.leave_above)} mm`;
  return {
    kind: frozen || !known ? "" : active ? "alarm" : "live", name: zone.name, state,
    cause: cause && `why: ${cause}`,
    title: `${zone.name}: ${state}${active ? `\nEntered at cycle ${cycle}; why: ${cause}; pair: ${pair}` : ""}\n${rule}`,
  };
}

function made({ kind, name, state, cause, title }) {
  const chip = Object.assign(document.createElement("span"), { className: `chip ${kind}`, title });
  chip.append(`${name} ${state}`);
  if (cause) chip.append(Object.assign(document.createElement("small"), { textContent: cause }));
  return chip;
}

// Hides chips at the end until the row fits, and counts them.
function fitRow(row, chips) {
  const more = row.appendChild(Object.assign(document.createElement("span"), { className: "chip more", hidden: true }));
  const all = [...row.children].slice(0, -1);
  for (let shown = all.length; shown >= 0; --shown) {
    const hidden = chips.slice(shown), active = hidden.filter(({ state }) => state === "ACTIVE").length;
    all.forEach((chip, i) => (chip.hidden = i >= shown));
    more.hidden = hidden.length === 0;
    more.textContent = `+${hidden.length}${active ? `, ${active} ACTIVE` : ""}`;
    more.title = hidden.map(({ title }) => title).join("\n\n");
    more.classList.toggle("alarm", active > 0);
    if (row.scrollWidth <= row.clientWidth) return;
  }
}

// Active zones come first.
export function drawZones(state, frozen) {
  const row = element("zones"), chips = state.zoneStates().map((zone) => chipOf(zone, frozen));
  chips.sort((a, b) => (b.state === "ACTIVE") - (a.state === "ACTIVE"));
  const key = JSON.stringify([chips, row.clientWidth]);
  if (row.dataset.key === key) return;
  row.dataset.key = key;
  row.replaceChildren(...chips.map(made));
  fitRow(row, chips);
}
