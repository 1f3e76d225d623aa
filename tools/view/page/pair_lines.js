// Closest pairs as lines between their witness points, with constant width on the screen, and with distance and bounds
// beside the important ones.
import * as THREE from "three";
import { css, isKnown, mm, put } from "./format.js";
import { LabelPlaces } from "./labels.js";

const MOST_LINES = 64, MOST_LABELS = 4;
const MOST_RECTANGLES = 48; // of bodies that labels avoid
const AGAIN_MS = 100; // between texts; their places follow every frame
const WIDTH = 0.0016, POINT = 0.0042; // share of the distance to the camera
export const COLOUR = { inside: "--alarm", leaving: "--near", outside: "--good", free: "--accent", meant: "--quiet", lost: "--lost" };

const vector = ({ x, y, z }) => new THREE.Vector3(x, y, z);

// Pixels of a projected point.
const screenOf = (camera, { width, height }) => ({ x, y }) => ({ x: (0.5 + 0.5 * x) * width, y: (0.5 - 0.5 * y) * height });

// The rectangles on the screen of the `first` objects, and of moving ones.
function rectanglesOf(bodies, first, camera, onScreen) {
  const boxes = bodies.movingBoxes(), objects = [...new Set([...first, ...boxes.keys()])].slice(0, MOST_RECTANGLES);
  return objects.map((object) => {
    const box = boxes.get(object) ?? bodies.bounds((each) => each === bodies.cell.objects[object]);
    const rectangle = { left: Infinity, top: Infinity, right: -Infinity, bottom: -Infinity };
    for (let i = 0; i < 8; ++i) {
      const corner = new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z);
      const { x, y } = onScreen(corner.project(camera));
      Object.assign(rectangle, { left: Math.min(rectangle.left, x), right: Math.max(rectangle.right, x), top: Math.min(rectangle.top, y), bottom: Math.max(rectangle.bottom, y) });
    }
    return { object, rectangle };
  }).filter(({ rectangle: { left, right } }) => Number.isFinite(left) && right > left);
}

export class PairLines extends THREE.Group {
  // `labels` is the element that holds them; `choose(pair)` is called for a clicked label, `look(pair)` for two clicks.
  constructor(labels, choose, look) {
    super();
    this.labels = labels;
    this.leaders = labels.appendChild(document.createElementNS("http://www.w3.org/2000/svg", "svg"));
    this.places = new LabelPlaces();
    this.choose = choose;
    this.look = look;
    const flat = () => new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
    this.lines = new THREE.InstancedMesh(new THREE.CylinderGeometry(1, 1, 1, 6).rotateX(Math.PI / 2), flat(), MOST_LINES);
    this.points = new THREE.InstancedMesh(new THREE.SphereGeometry(1, 10, 6), flat(), 2 * MOST_LINES);
    for (const mesh of [this.lines, this.points]) {
      mesh.frustumCulled = false;
      mesh.renderOrder = 10;
      this.add(mesh);
    }
    this.pool = [];
    this.shown = [];
  }

  // First the least pair, then the chosen ones, then those that limit a robot's speed, then those in zones by distance.
  static which(state, chosen) {
    const minimum = state.minimum();
    const found = new Map(minimum ? [[minimum.pair, minimum]] : []);
    const pairs = state.report.pairs.filter(isKnown);
    for (const pair of pairs) if (chosen.has(pair.pair) && !found.has(pair.pair)) found.set(pair.pair, pair);
    const near = pairs.filter((pair) => ["inside", "leaving"].includes(state.levelOf(pair))).sort((a, b) => state.limiting.has(b.pair) - state.limiting.has(a.pair) || a.lower - b.lower);
    for (const pair of near) if (found.size < MOST_LINES && !found.has(pair.pair)) found.set(pair.pair, pair);
    return [...found.values()].filter(({ witness_a: { x } }) => Number.isFinite(x));
  }

  update(state, chosen, camera, size, bodies) {
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
    this.label(state, chosen, camera, size, bodies);
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

  // Labels stand beside the bodies that they name, with lines that lead to the middles of their pairs.
  label(state, chosen, camera, size, bodies) {
    const nowMs = performance.now(), isDue = nowMs - (this.filledMs ?? 0) > AGAIN_MS;
    if (isDue) this.filledMs = nowMs;
    const onScreen = screenOf(camera, size);
    const lines = this.shown.slice(0, MOST_LABELS).map(({ pair, a, b, level }, i) => {
      const element = (this.pool[i] ??= this.makeLabel()), middle = a.clone().lerp(b, 0.5).project(camera);
      element.hidden = middle.z > 1 || Math.abs(middle.x) > 1.05 || Math.abs(middle.y) > 1.05;
      if (isDue || Number(element.dataset.pair) !== pair.pair) this.fill(element, pair, level, state, chosen, i > 0);
      return { element, key: pair.pair, ...onScreen(middle), a: onScreen(a.clone().project(camera)), b: onScreen(b.clone().project(camera)),
        width: element.labelWidth, height: element.labelHeight, objects: [state.pairs[pair.pair].a, state.pairs[pair.pair].b] };
    });
    const visible = lines.filter(({ element }) => !element.hidden);
    if (isDue) this.rectangles = rectanglesOf(bodies, visible.flatMap(({ objects }) => objects), camera, onScreen);
    this.placed = this.places.choose(visible, visible, this.rectangles ?? [], size, nowMs);
    this.placed.forEach(({ box, end }, i) => {
      const { element, x, y } = visible[i];
      element.style.transform = `translate(${Math.round(box.left)}px, ${Math.round(box.top)}px)`;
      for (const [name, value] of [["x1", x], ["y1", y], ["x2", end.x], ["y2", end.y]]) element.leader.setAttribute(name, value.toFixed(1));
    });
    for (const element of this.pool.slice(Math.min(this.shown.length, MOST_LABELS))) element.hidden = true;
    for (const element of this.pool) element.leader.style.display = element.hidden ? "none" : "";
  }

  fill(element, pair, level, state, chosen, isFurther) {
    element.dataset.pair = pair.pair;
    element.style.setProperty("--label", `var(${COLOUR[level]})`);
    element.classList.toggle("chosen", chosen.has(pair.pair));
    element.classList.toggle("slight", isFurther && !chosen.has(pair.pair));
    put(element.firstChild, `${mm(pair.distance)} mm`);
    put(element.lastChild, `[${mm(pair.lower, 2)}, ${mm(pair.upper, 2)}] ${state.pairs[pair.pair].name}`);
    element.leader.style.stroke = `var(${COLOUR[level]})`;
    [element.labelWidth, element.labelHeight] = [element.offsetWidth, element.offsetHeight];
  }

  makeLabel() {
    const element = document.createElement("div");
    element.className = "label";
    element.append(document.createElement("span"), document.createElement("small"));
    element.onclick = () => this.choose(Number(element.dataset.pair));
    element.ondblclick = () => this.look(Number(element.dataset.pair));
    element.leader = this.leaders.appendChild(document.createElementNS("http://www.w3.org/2000/svg", "line"));
    this.labels.append(element);
    return element;
  }

  // The pair whose line passes within a few pixels of a point of the screen.
  pairAt(x, y, camera, size) {
    const toScreen = screenOf(camera, size);
    const onScreen = (point) => new THREE.Vector2().copy(toScreen(point.clone().project(camera)));
    const here = new THREE.Vector2(x, y);
    return this.shown.find(({ a, b }) => {
      const from = onScreen(a), along = onScreen(b).sub(from);
      const share = Math.min(1, Math.max(0, here.clone().sub(from).dot(along) / Math.max(1e-9, along.lengthSq())));
      return from.addScaledVector(along, share).distanceTo(here) < 10;
    })?.pair.pair;
  }
}
