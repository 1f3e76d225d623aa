// Closest pairs as lines between their witness points, with constant width on the screen, and with distance and bounds
// beside the important ones.
import * as THREE from "three";
import { css, mm, put } from "./format.js";
import { isKnown } from "./format.js";

const MOST_LINES = 64, MOST_LABELS = 4;
const AGAIN_MS = 100; // between texts; their places follow every frame
const WIDTH = 0.0016, POINT = 0.0042; // share of the distance to the camera
export const COLOUR = { inside: "--alarm", leaving: "--near", outside: "--good", free: "--accent", lost: "--lost" };

const vector = ({ x, y, z }) => new THREE.Vector3(x, y, z);

export class PairLines extends THREE.Group {
  // `labels` is the element that holds them; `choose(pair)` is called for a clicked label.
  constructor(labels, choose) {
    super();
    this.labels = labels;
    this.choose = choose;
    const flat = () => new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
    this.lines = new THREE.InstancedMesh(new THREE.CylinderGeometry(1, 1, 1, 8).rotateX(Math.PI / 2), flat(), MOST_LINES);
    this.points = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 12, 8), flat(), 2 * MOST_LINES);
    for (const mesh of [this.lines, this.points]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 10;
      this.add(mesh);
    }
    this.pool = [];
    this.shown = [];
  }

  // First the least pair, then the chosen ones, then those in zones by distance.
  static which(state, chosen) {
    const minimum = state.minimum();
    const found = new Map(minimum ? [[minimum.pair, minimum]] : []);
    const pairs = state.report.pairs.filter(isKnown);
    for (const pair of pairs) if (chosen.has(pair.pair) && !found.has(pair.pair)) found.set(pair.pair, pair);
    const near = pairs.filter((pair) => ["inside", "leaving"].includes(state.levelOf(pair))).sort((a, b) => a.lower - b.lower);
    for (const pair of near) if (found.size < MOST_LINES && !found.has(pair.pair)) found.set(pair.pair, pair);
    return [...found.values()].filter(({ witness_a: { x } }) => Number.isFinite(x));
  }

  update(state, chosen, camera, size) {
    this.shown = PairLines.which(state, chosen).map((pair) => ({
      pair, a: vector(pair.witness_a), b: vector(pair.witness_b), level: state.levelOf(pair),
    }));
    this.lines.count = this.shown.length;
    this.points.count = 2 * this.shown.length;
    this.shown.forEach((line, i) => this.draw(line, i, camera));
    for (const mesh of [this.lines, this.points]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
    this.label(state, chosen, camera, size);
  }

  draw({ a, b, level }, i, camera) {
    const middle = a.clone().lerp(b, 0.5);
    const away = middle.distanceTo(camera.position);
    const colour = new THREE.Color(css(COLOUR[level]));
    const width = WIDTH * away;
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), b.clone().sub(a).normalize());
    this.lines.setMatrixAt(i, new THREE.Matrix4().compose(middle, turn, new THREE.Vector3(width, width, a.distanceTo(b))));
    this.lines.setColorAt(i, colour);
    [a, b].forEach((point, end) => {
      const radius = POINT * away;
      this.points.setMatrixAt(2 * i + end, new THREE.Matrix4().compose(point, new THREE.Quaternion(), new THREE.Vector3(radius, radius, radius)));
      this.points.setColorAt(2 * i + end, colour);
    });
  }

  // Labels lie beside the middles of their lines, from the top down, and below each other instead of overlapping.
  label(state, chosen, camera, { width, height }) {
    const isDue = performance.now() - (this.filledMs ?? 0) > AGAIN_MS;
    if (isDue) this.filledMs = performance.now();
    const placed = this.shown.slice(0, MOST_LABELS).map(({ pair, a, b, level }, i) => {
      const element = (this.pool[i] ??= this.makeLabel());
      const at = a.clone().lerp(b, 0.5).project(camera);
      element.hidden = at.z > 1 || Math.abs(at.x) > 1.05 || Math.abs(at.y) > 1.05;
      if (isDue || Number(element.dataset.pair) !== pair.pair) this.fill(element, pair, level, state, chosen, i > 0);
      return { element, x: Math.min((at.x * 0.5 + 0.5) * width + 14, width - 250), y: (0.5 - at.y * 0.5) * height - 18 };
    }).filter(({ element }) => !element.hidden).sort((one, other) => one.y - other.y);
    placed.forEach((label, i) => {
      for (const above of placed.slice(0, i)) if (Math.abs(above.x - label.x) < 250) label.y = Math.max(label.y, above.y + 46);
      label.element.style.transform = `translate(${Math.round(label.x)}px, ${Math.round(label.y)}px)`;
    });
    for (const element of this.pool.slice(Math.min(this.shown.length, MOST_LABELS))) element.hidden = true;
  }

  fill(element, pair, level, state, chosen, isFurther) {
    element.dataset.pair = pair.pair;
    element.style.setProperty("--label", `var(${COLOUR[level]})`);
    element.classList.toggle("chosen", chosen.has(pair.pair));
    element.classList.toggle("slight", isFurther && !chosen.has(pair.pair));
    put(element.firstChild, `${mm(pair.distance)} mm`);
    put(element.lastChild, `[${mm(pair.lower, 2)}, ${mm(pair.upper, 2)}] ${state.pairs[pair.pair].name}`);
  }

  makeLabel() {
    const element = document.createElement("div");
    element.className = "label";
    element.append(document.createElement("span"), document.createElement("small"));
    element.onclick = () => this.choose(Number(element.dataset.pair));
    this.labels.append(element);
    return element;
  }

  hide() {
    this.lines.count = this.points.count = 0;
    for (const element of this.pool) element.hidden = true;
  }

  // The pair whose line passes within a few pixels of a point of the screen.
  pairAt(x, y, camera, { width, height }) {
    const onScreen = (point) => {
      const at = point.clone().project(camera);
      return new THREE.Vector2((at.x * 0.5 + 0.5) * width, (0.5 - at.y * 0.5) * height);
    };
    const here = new THREE.Vector2(x, y);
    return this.shown.find(({ a, b }) => {
      const from = onScreen(a), along = onScreen(b).sub(from);
      const share = Math.min(1, Math.max(0, here.clone().sub(from).dot(along) / Math.max(1e-9, along.lengthSq())));
      return from.addScaledVector(along, share).distanceTo(here) < 10;
    })?.pair.pair;
  }
}
