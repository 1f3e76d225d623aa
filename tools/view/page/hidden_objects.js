// The objects that a person has hidden, by group or one by one, and the list for that. Only their bodies are hidden:
// lines, labels, the table and all alarms still have all their pairs.
import { counted } from "./format.js";

const WITHOUT = "without a group";
const GROUP = "group:"; // in addresses, before the names of groups that are hidden as a whole

const element = (id) => document.getElementById(id);

export class HiddenObjects {
  // `changed(objects)` is called with the numbers of all that are hidden.
  constructor({ objects }, changed) {
    this.objects = objects;
    this.changed = changed;
    this.hidden = new Set();
    this.groups = new Map();
    objects.forEach(({ groups }, object) => {
      for (const group of groups.length ? groups : [WITHOUT]) this.groups.set(group, [...(this.groups.get(group) ?? []), object]);
    });
    this.list = element("object-list");
    element("all-objects").onclick = () => this.set([...this.hidden], false);
    element("hidden-count").onclick = () => this.set([...this.hidden], false);
  }

  set(objects, isHidden) {
    for (const object of objects) isHidden ? this.hidden.add(object) : this.hidden.delete(object);
    this.show();
    this.changed(this.hidden);
  }
  toggle(object) {
    this.set([object], !this.hidden.has(object));
  }

  // For addresses: names of objects, and of groups that are hidden as a whole.
  get names() {
    const groups = [...this.groups].filter(([, members]) => members.every((object) => this.hidden.has(object)));
    const inGroups = new Set(groups.flatMap(([, members]) => members));
    return [...groups.map(([name]) => GROUP + name), ...[...this.hidden].filter((object) => !inGroups.has(object)).map((object) => this.objects[object].name)];
  }
  set names(names) {
    const known = new Map(this.objects.map(({ name }, object) => [name, object]));
    const found = names.flatMap((name) => (name.startsWith(GROUP) ? this.groups.get(name.slice(GROUP.length)) ?? [] : known.has(name) ? [known.get(name)] : []));
    if (found.length) this.set(found, true);
  }

  // The list is made when it is first shown.
  toggleList() {
    element("objects").hidden = !element("objects").hidden;
    element("object-button").setAttribute("aria-pressed", !element("objects").hidden);
    this.boxes ??= this.makeList();
    this.show();
  }
  makeList() {
    const boxes = [];
    const row = (tag, name, members) => {
      const line = document.createElement(tag), label = document.createElement("label"), box = Object.assign(document.createElement("input"), { type: "checkbox" });
      box.onchange = () => this.set(members, !box.checked);
      boxes.push({ box, members });
      label.append(box, ` ${name}`);
      line.append(label);
      return line;
    };
    for (const [name, members] of this.groups) {
      const group = document.createElement("details");
      const summary = row("summary", name, members);
      summary.append(Object.assign(document.createElement("small"), { textContent: members.length }));
      group.append(summary, ...members.map((object) => row("div", this.objects[object].name, [object])));
      this.list.append(group);
    }
    return boxes;
  }

  show() {
    for (const { box, members } of this.boxes ?? []) {
      const hidden = members.filter((object) => this.hidden.has(object)).length;
      box.checked = hidden < members.length;
      box.indeterminate = hidden > 0 && hidden < members.length;
    }
    element("hidden-count").hidden = this.hidden.size === 0;
    element("hidden-count").textContent = `${counted(this.hidden.size, "object")} not drawn`;
  }
}
