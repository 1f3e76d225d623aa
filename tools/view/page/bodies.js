// The bodies of the cell in a few draw calls. Moving parts are one group. Parts that stand still
// (`still`), and those of them that have faded (`veil`), are groups of their own. `glass` has moving parts that are
// shown through.
import * as THREE from "three";
import { css } from "./format.js";
import { gridOn } from "./grid.js";
import { edgesOf, everywhere, Placements, trianglesOf } from "./placements.js";
import { hidingObjects } from "./hiding.js";
import { DRAWS, edgeMaterial, solidMaterial } from "./solid_material.js";

// Hues of moving groups, distinct from the hues of levels and of unknown poses: red, amber, green, violet.
const MOVING = ["#4f8fe8", "#a88b6a", "#3fa7c4", "#c77fc9", "#7f8f4f", "#6c86a3"];

// A hue for each name, by the name: another object or order changes it only where two would share one.
function huesOf(names) {
  const taken = new Map();
  for (const name of [...new Set(names)].sort()) {
    const free = [...MOVING.keys()].map((i) => MOVING[(hashOf(name) + i) % MOVING.length]).find((hue) => ![...taken.values()].includes(hue));
    taken.set(name, free ?? MOVING[hashOf(name) % MOVING.length]);
  }
  return taken;
}

export const matrixOf = ([x, y, z, qx, qy, qz, qw]) =>
  new THREE.Matrix4().compose(new THREE.Vector3(x, y, z), new THREE.Quaternion(qx, qy, qz, qw), new THREE.Vector3(1, 1, 1));

// A floor is wider than all else by this, is a plate of at most this thickness as a share of its width, and may be this far above the
// lowest point of what stands on it, m.
const FLOOR = 1.2, PLATE = 0.1, SUNK = 0.05;
const widthOf = ({ min, max }) => Math.max(max.x - min.x, max.y - min.y);
const isPlate = (box) => box.max.z - box.min.z <= PLATE * widthOf(box);
// A number that depends on the name alone.
const hashOf = (name) => [...name].reduce((hash, letter) => (Math.imul(hash, 31) + letter.codePointAt(0)) >>> 0, 7);

export const ALBEDO = 0.78; // of white paint: a whiter one would have no shades in this light
const ABOVE = new THREE.Vector3(-0.25, 0.12, 0.8); // direction of the light, relative to the viewer
const world = new THREE.Matrix4(), box = new THREE.Box3(); // reused in every frame

export class Bodies extends THREE.Group {
  constructor(scene) {
    super();
    this.cell = scene;
    this.still = new THREE.Group();
    this.veil = new THREE.Group();
    this.glass = new THREE.Group();
    this.stillChanges = 0; // counts changes in the look of what stands still
    this.poses = scene.objects.map(({ pose }) => (pose ? matrixOf(pose) : undefined));
    // Moving parts come first: a part below `moving` has that number in the first placements, the others in the second.
    const drawn = scene.parts.filter(({ mesh }) => mesh !== undefined);
    const fixed = ({ object }) => scene.objects[object].fixed;
    const kinds = [drawn.filter((part) => !fixed(part)), drawn.filter(fixed)];
    this.parts = kinds.flat();
    this.moving = kinds[0].length;
    this.placements = kinds.map((parts) => new Placements(parts.length));
    this.lights = { sun: { value: new THREE.Vector3(0, 0, 1) } };
    this.faded = new Set(); // objects
    this.replaced = new Set(); // objects that something else shows
    this.isGlass = false; // whether these are still seen, as glass
    this.off = new Set(); // objects that a person has hidden
    this.veil.visible = this.glass.visible = false;
    this.edgeColour = { value: new THREE.Color() };
    this.local = this.parts.map(({ pose }) => matrixOf(pose));
    this.ofObject = scene.objects.map(() => []);
    this.parts.forEach(({ object }, i) => this.ofObject[object].push(i));
    this.chosen = new Set();
    this.late = new Map();
    this.hues = huesOf(scene.objects.filter(({ fixed }) => !fixed).map(({ groups }) => groups[0] ?? ""));
    this.index = new Map(scene.objects.map(({ name }, i) => [name, i]));
    this.build(kinds, scene.meshes);
    this.grids = scene.parts.filter(({ plane }) => plane).map((part) => gridOn(part, scene.objects[part.object]));
    for (const grid of this.grids) (scene.objects[grid.userData.object].fixed ? this.still : this).add(grid);
    this.ofObject.forEach((_, object) => this.place(object));
    this.recolour();
  }

  build(kinds, meshes) {
    kinds.forEach((parts, kind) => {
      if (!parts.length) return;
      const placements = this.placements[kind], triangles = trianglesOf(parts, meshes);
      const solid = (draws) => everywhere(new THREE.Mesh(triangles, solidMaterial(placements, this.lights, draws)));
      const segments = edgesOf(parts, meshes);
      const edges = (draws) => everywhere(new THREE.LineSegments(segments, edgeMaterial(placements, draws, this.edgeColour)));
      const groups = kind === 0 ? [[this, DRAWS.solid], [this.glass, DRAWS.faded]] : [[this.still, DRAWS.solid], [this.veil, DRAWS.faded]];
      for (const [group, draws] of groups) group.add(solid(draws), edges(draws));
    });
    this.glass.traverse((each) => (each.renderOrder = 3));
    this.add(this.glass);
    this.shapes = meshes.map(({ positions, triangles }) => {
      const shape = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(positions, 3)).setIndex(triangles);
      shape.computeBoundingBox();
      shape.computeBoundingSphere();
      return shape;
    });
    // The median of a box's lengths: thin bars are thin, plates are not.
    this.thickness = this.parts.map(({ mesh }) => this.shapes[mesh].boundingBox.getSize(new THREE.Vector3()).toArray().sort((a, b) => a - b)[1]);
  }
  // The placements of a part, and its number there.
  placedBy(part) {
    return part < this.moving ? [this.placements[0], part] : [this.placements[1], part - this.moving];
  }
  placed(part) {
    const [placements, i] = this.placedBy(part);
    return placements.matrices[i];
  }

  // Takes [object's name, pose] of each known pose; returns true when an object became known.
  move(transforms) {
    let isNew = false;
    for (const [name, pose] of transforms) {
      const object = this.index.get(name);
      if (object === undefined || (this.cell.objects[object].fixed && this.poses[object])) continue;
      isNew ||= this.poses[object] === undefined;
      this.poses[object] = matrixOf(pose);
      this.place(object);
    }
    return isNew;
  }

  place(object) {
    const pose = this.poses[object];
    for (const part of this.ofObject[object]) {
      const [placements, i] = this.placedBy(part);
      placements.place(i, pose && world.multiplyMatrices(pose, this.local[part]));
    }
    for (const grid of this.grids) if (grid.userData.object === object && pose) grid.follow(pose);
  }

  // `css(name)` is a colour of the theme.
  colourOf(object, css) {
    if (this.late.has(object)) return css("--lost");
    if (this.chosen.has(object)) return css("--accent");
    const { fixed, groups, colour } = this.cell.objects[object];
    if (colour) return `rgb(${colour.map((each) => Math.round(255 * ALBEDO * each)).join()})`;
    return fixed ? css("--body") : this.hues.get(groups[0] ?? "");
  }

  // Called after a change of the theme, the selection or the late objects.
  recolour() {
    ++this.stillChanges;
    const colour = new THREE.Color(), byName = new Map();
    const known = (name) => byName.get(name) ?? byName.set(name, css(name)).get(name);
    this.ofObject.forEach((parts, object) => {
      if (parts.length) colour.set(this.colourOf(object, known));
      for (const part of parts) {
        const [placements, i] = this.placedBy(part);
        placements.colour(i, colour, this.thickness[part], this.lookOf(object));
      }
    });
    this.edgeColour.value.set(css("--edge"));
    for (const grid of this.grids) {
      grid.material.uniforms.colour.value.set(css("--grid"));
      grid.visible = !this.off.has(grid.userData.object);
    }
  }
  lookOf(object) {
    if (this.off.has(object)) return "hidden";
    if (this.replaced.has(object)) return this.isGlass ? "faded" : "hidden";
    return this.faded.has(object) ? "faded" : "solid";
  }
  choose(objects) {
    this.chosen = new Set(objects);
    this.recolour();
  }
  setLate(late) {
    const same = late.size === this.late.size && [...late.keys()].every((object) => this.late.has(object));
    this.late = late;
    if (!same) this.recolour();
  }

  // True for objects that are somewhere, and that no person has hidden.
  isShown(object) {
    return this.poses[object] !== undefined && !this.off.has(object);
  }
  // A box around everything that is shown, or around some of it.
  bounds(of = () => true) {
    const all = new THREE.Box3();
    this.parts.forEach(({ object, unbounded }, part) => {
      if (unbounded || !this.isShown(object) || !of(this.cell.objects[object])) return;
      all.union(box.copy(this.shapes[this.parts[part].mesh].boundingBox).applyMatrix4(this.placed(part)));
    });
    return all;
  }
  // The same without floors: plates below all else that are wider than it.
  boundsWithoutFloors() {
    const all = new THREE.Box3(), boxes = [...this.boxes(this.parts.length)].map(([object, box]) => ({ box, isStill: this.cell.objects[object].fixed }));
    for (const { box, isStill } of boxes) {
      const others = isStill && isPlate(box) ? boxes.filter(({ box: each }) => !(isPlate(each) && each.max.z <= box.max.z)) : [];
      const rest = others.reduce((sum, { box: each }) => sum.union(each), new THREE.Box3());
      const isFloor = !rest.isEmpty() && box.max.z <= rest.min.z + SUNK && widthOf(box) > FLOOR * widthOf(rest);
      if (!isFloor) all.union(box);
    }
    return all;
  }
  // The boxes of moving objects in the world.
  movingBoxes() {
    return this.boxes(this.moving);
  }
  // By object, of the first parts.
  boxes(parts) {
    const boxes = new Map();
    for (let part = 0; part < parts; ++part) {
      const { object, unbounded, mesh } = this.parts[part];
      if (unbounded || !this.isShown(object)) continue;
      if (!boxes.has(object)) boxes.set(object, new THREE.Box3());
      boxes.get(object).union(box.copy(this.shapes[mesh].boundingBox).applyMatrix4(this.placed(part)));
    }
    return boxes;
  }
  // Something else shows these objects, or none; their bodies are left out, or are glass.
  replace(objects, isGlass) {
    this.replaced = new Set(objects);
    this.isGlass = this.glass.visible = isGlass;
    this.veil.visible = isGlass || this.faded.size > 0;
    this.recolour();
  }
  turnOff(objects) {
    this.off = new Set(objects);
    this.recolour();
  }
  // Bodies between the eye and moving ones fade.
  fade(eye) {
    const still = this.parts.slice(this.moving).map(({ object, mesh }, i) => ({ object, shape: this.shapes[mesh], matrix: this.placements[1].matrices[i] }));
    const hiding = hidingObjects(eye, [...this.movingBoxes().values()], still.filter(({ object }) => this.isShown(object)), this.faded);
    if (hiding.size === this.faded.size && [...hiding].every((object) => this.faded.has(object))) return;
    this.faded = hiding;
    this.veil.visible = this.isGlass || hiding.size > 0;
    this.recolour();
  }

  // The light comes from behind the viewer.
  lit(camera, target) {
    this.lights.sun.value.copy(camera.position).sub(target).normalize().add(ABOVE).normalize();
  }

  objectAt(raycaster) {
    const probe = new THREE.Mesh(), hits = [];
    this.parts.forEach(({ mesh, object }, part) => {
      if (!this.isShown(object) || this.faded.has(object)) return;
      probe.geometry = this.shapes[mesh];
      probe.matrixWorld = this.placed(part);
      const found = [];
      probe.raycast(raycaster, found);
      for (const { distance } of found) hits.push({ distance, object });
    });
    return hits.sort((one, other) => one.distance - other.distance)[0]?.object;
  }
}
