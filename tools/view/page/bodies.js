// The bodies of the cell in one draw call, their sharp edges in another: a thousand objects move at the cost of two
// textures of matrices.
import * as THREE from "three";
import { css } from "./format.js";
import { gridOn } from "./grid.js";

const MOST_FOCUS = 0.8; // of the cell's radius
// Hues of groups that move, kept apart from those that say how near: red, amber, green.
const MOVING = ["#4f8fe8", "#8f7ae5", "#3fa7c4", "#c77fc9", "#6f9a5a", "#b58a5c"];

export const matrixOf = ([x, y, z, qx, qy, qz, qw]) =>
  new THREE.Matrix4().compose(new THREE.Vector3(x, y, z), new THREE.Quaternion(qx, qy, qz, qw), new THREE.Vector3(1, 1, 1));

export function geometryOf({ positions, normals, triangles }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.Float32BufferAttribute(normals, 3));
  geometry.setIndex(triangles);
  return geometry;
}

// What stands between the camera and what moves is seen through: one material leaves those fragments out, the other
// draws only them, faintly. `focus`: centre and radius of what moves, shared by both.
function cutAway(material, focus, isGhost) {
  material.onBeforeCompile = (shader) => {
    shader.uniforms.focus = focus;
    shader.fragmentShader = shader.fragmentShader
      .replace("void main() {", `uniform vec4 focus;
        bool inFront() {
          vec3 centre = (viewMatrix * vec4(focus.xyz, 1.0)).xyz, here = -vViewPosition;
          vec3 axis = normalize(centre);
          float along = dot(here, axis), away = length(here - axis * along);
          return along < length(centre) - 0.55 * focus.w && away < 1.15 * focus.w * along / length(centre);
        }
        void main() {
          if (inFront() != ${isGhost}) discard;`);
  };
  material.customProgramCacheKey = () => `cut away ${isGhost}`;
  return material;
}

// Instances of several meshes in one BatchedMesh; `parts` have {mesh}.
export function batch(parts, meshes, material) {
  const used = [...new Set(parts.map(({ mesh }) => mesh))];
  const sum = (count) => used.reduce((all, mesh) => all + count(meshes[mesh]), 0);
  const batched = new THREE.BatchedMesh(parts.length, sum(({ positions }) => positions.length / 3), sum(({ triangles }) => triangles.length), material);
  const ids = new Map(used.map((mesh) => [mesh, batched.addGeometry(geometryOf(meshes[mesh]))]));
  for (const part of parts) batched.addInstance(ids.get(part.mesh));
  batched.frustumCulled = false;
  batched.perObjectFrustumCulled = false;
  batched.sortObjects = false;
  return batched;
}

// Lines that each follow the matrix of a part, read from a texture of 4 texels a part.
function edgeLines(parts, meshes) {
  const texture = new THREE.DataTexture(new Float32Array(16 * Math.max(1, parts.length)), 4, Math.max(1, parts.length), THREE.RGBAFormat, THREE.FloatType);
  const positions = [], owners = [];
  parts.forEach(({ mesh }, part) => {
    const { edges } = meshes[mesh];
    positions.push(...edges);
    for (let i = 0; i < edges.length / 3; ++i) owners.push(part);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(positions, 3));
  geometry.setAttribute("owner", new THREE.Float32BufferAttribute(owners, 1));
  const material = new THREE.ShaderMaterial({
    uniforms: { matrices: { value: texture }, colour: { value: new THREE.Color() } },
    transparent: true,
    vertexShader: `uniform highp sampler2D matrices; attribute float owner;
      vec4 column(int i) { return texelFetch(matrices, ivec2(i, int(owner)), 0); }
      void main() {
        mat4 placed = mat4(column(0), column(1), column(2), column(3));
        gl_Position = projectionMatrix * viewMatrix * placed * vec4(position, 1.0);
        gl_Position.z -= 2e-5 * gl_Position.w;
      }`,
    fragmentShader: "uniform vec3 colour; void main() { gl_FragColor = vec4(colour, 0.55); }",
  });
  const lines = new THREE.LineSegments(geometry, material);
  lines.frustumCulled = false;
  return { lines, texture, material };
}

export class Bodies extends THREE.Group {
  constructor(scene) {
    super();
    this.cell = scene;
    this.poses = scene.objects.map(({ pose }) => (pose ? matrixOf(pose) : undefined));
    // What moves first: an index below `moving` is in `solid`, the others are in `still` and, seen through, in `ghost`.
    const drawn = scene.parts.filter(({ mesh }) => mesh !== undefined);
    const fixed = ({ object }) => scene.objects[object].fixed;
    this.parts = [...drawn.filter((part) => !fixed(part)), ...drawn.filter(fixed)];
    this.moving = drawn.length - drawn.filter(fixed).length;
    this.focus = { value: new THREE.Vector4(0, 0, 0, 0) };
    this.local = this.parts.map(({ pose }) => matrixOf(pose));
    this.ofObject = scene.objects.map(() => []);
    this.parts.forEach(({ object }, i) => this.ofObject[object].push(i));
    this.chosen = new Set();
    this.late = new Map();
    this.index = new Map(scene.objects.map(({ name }, i) => [name, i]));
    if (this.parts.length) this.build(scene.meshes);
    this.grids = scene.parts.filter(({ plane }) => plane).map((part) => gridOn(part, scene.objects[part.object]));
    for (const grid of this.grids) this.add(grid);
    this.ofObject.forEach((_, object) => this.place(object));
    this.recolour();
  }

  build(meshes) {
    const [moving, fixed] = [this.parts.slice(0, this.moving), this.parts.slice(this.moving)];
    if (moving.length) this.add((this.solid = batch(moving, meshes, new THREE.MeshLambertMaterial())));
    if (fixed.length) {
      this.still = batch(fixed, meshes, cutAway(new THREE.MeshLambertMaterial(), this.focus, false));
      const faint = { transparent: true, opacity: 0.13, depthWrite: false };
      this.ghost = batch(fixed, meshes, cutAway(new THREE.MeshLambertMaterial(faint), this.focus, true));
      this.add(this.still, this.ghost);
    }
    this.edges = edgeLines(this.parts, meshes);
    this.add(this.edges.lines);
    this.boxes = this.parts.map(({ mesh }) => new THREE.Box3().setFromArray(meshes[mesh].positions));
  }

  // [object's name, pose] of each that is known; true when one was seen for the first time.
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

  // Does this to a part in every batch that draws it.
  ofPart(part, act) {
    if (part < this.moving) return act(this.solid, part);
    act(this.still, part - this.moving);
    act(this.ghost, part - this.moving);
  }

  place(object) {
    const pose = this.poses[object];
    for (const part of this.ofObject[object]) {
      const matrix = pose ? pose.clone().multiply(this.local[part]) : new THREE.Matrix4().makeScale(0, 0, 0);
      this.ofPart(part, (batched, i) => {
        batched.setVisibleAt(i, pose !== undefined);
        batched.setMatrixAt(i, matrix);
      });
      matrix.toArray(this.edges.texture.image.data, 16 * part);
      this.edges.texture.needsUpdate = true;
    }
    for (const grid of this.grids ?? []) if (grid.userData.object === object && pose) grid.follow(pose);
  }

  colourOf(object) {
    if (this.late.has(object)) return css("--lost");
    if (this.chosen.has(object)) return css("--accent");
    const { fixed, groups } = this.cell.objects[object];
    if (fixed) return css("--body");
    this.groups ??= [...new Set(this.cell.objects.filter((each) => !each.fixed).map((each) => each.groups[0]))];
    return MOVING[this.groups.indexOf(groups[0]) % MOVING.length];
  }

  // After the theme, the selection or who is late has changed.
  recolour() {
    if (this.edges) {
      const colour = new THREE.Color();
      this.ofObject.forEach((parts, object) => {
        colour.set(this.colourOf(object));
        for (const part of parts) this.ofPart(part, (batched, i) => batched.setColorAt(i, colour));
      });
      this.edges.material.uniforms.colour.value.set(css("--edge"));
    }
    for (const grid of this.grids) grid.material.uniforms.colour.value.set(css("--grid"));
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

  // Around everything whose pose is known, or around some of it.
  bounds(of = () => true) {
    const all = new THREE.Box3();
    this.parts.forEach(({ object, unbounded }, part) => {
      if (unbounded || !this.poses[object] || !of(this.cell.objects[object])) return;
      all.union(this.boxes[part].clone().applyMatrix4(this.poses[object].clone().multiply(this.local[part])));
    });
    return all;
  }
  // What moves is where the view is cut away to; where that is most of the cell, nothing is.
  refocus() {
    const moving = this.bounds(({ fixed }) => !fixed);
    if (moving.isEmpty()) return;
    const { center, radius } = moving.getBoundingSphere(new THREE.Sphere());
    const isMost = radius > MOST_FOCUS * this.bounds().getBoundingSphere(new THREE.Sphere()).radius;
    this.focus.value.set(...center, isMost ? 0 : radius);
    if (this.ghost) this.ghost.visible = !isMost;
  }

  // Roughly: what is so near is seen through.
  isCutAway(distance) {
    return this.focus.value.w > 0 && distance < this.eye.distanceTo(new THREE.Vector3(...this.focus.value)) - 0.55 * this.focus.value.w;
  }
  objectAt(raycaster) {
    this.eye = raycaster.ray.origin;
    const batches = [this.solid, this.still].filter(Boolean);
    const [hit] = raycaster.intersectObjects(batches).filter(({ object, distance }) => object === this.solid || !this.isCutAway(distance));
    if (!hit) return undefined;
    return this.parts[hit.batchId + (hit.object === this.solid ? 0 : this.moving)].object;
  }
}
