// The looks of robots' links, as their URDFs have them, in place of the bodies that the queries use, or within them.
import * as THREE from "three";
import { ALBEDO, matrixOf } from "./bodies.js";
import { css } from "./format.js";
import { plainMaterial } from "./solid_material.js";

const AGAIN_MS = 300; // while the server reads the meshes

// What is drawn of robots: the bodies, their looks, or their looks with the bodies around them as glass.
export const MODES = ["bodies", "looks", "both"];

// The server's /visuals.bin; undefined while it is being made.
async function fetched() {
  const bytes = await (await fetch("/visuals.bin")).arrayBuffer();
  if (!bytes.byteLength) return undefined;
  const length = new DataView(bytes).getUint32(0, true);
  const found = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  let at = 4 + length;
  const take = (Type, count) => {
    const numbers = new Type(bytes, at, count);
    at += numbers.byteLength;
    return new THREE.BufferAttribute(numbers, Type === Uint32Array ? 1 : 3);
  };
  const shapes = found.meshes.map(({ vertices, triangles }) => new THREE.BufferGeometry()
    .setAttribute("position", take(Float32Array, 3 * vertices)).setAttribute("normal", take(Float32Array, 3 * vertices))
    .setIndex(take(Uint32Array, 3 * triangles)));
  return { ...found, shapes };
}

export class Visuals extends THREE.Group {
  constructor(bodies) {
    super();
    this.bodies = bodies;
    this.visible = false;
    this.mode = "bodies";
    this.leftOut = []; // texts
  }

  // The meshes are fetched when they are first needed.
  async show(mode) {
    this.mode = mode;
    this.isLoading = mode !== "bodies";
    if (this.isLoading) await (this.loaded ??= this.load());
    this.isLoading = false;
    this.visible = this.mode !== "bodies";
    this.bodies.replace(this.visible ? this.children.map(({ userData }) => userData.object) : [], this.mode === "both");
  }

  async load() {
    let found;
    while (!(found = await fetched())) await new Promise((done) => setTimeout(done, AGAIN_MS));
    this.leftOut = found.left_out;
    for (const { object, pose, mesh, colour } of found.visuals) {
      const visual = new THREE.Mesh(found.shapes[mesh], plainMaterial(this.bodies.lights));
      visual.matrixAutoUpdate = false;
      visual.userData = { object, local: matrixOf(pose), colour: colour && new THREE.Color().setRGB(...colour, THREE.SRGBColorSpace) };
      this.add(visual);
    }
  }

  // Puts them where their objects are. Late and chosen objects have the colours of such bodies.
  update() {
    if (!this.visible) return;
    const { poses, late, chosen } = this.bodies;
    for (const visual of this.children) {
      const { object, local, colour } = visual.userData;
      visual.visible = this.bodies.isShown(object);
      if (!visual.visible) continue;
      visual.matrix.multiplyMatrices(poses[object], local);
      visual.matrixWorldNeedsUpdate = true;
      const isMarked = late.has(object) || chosen.has(object) || !colour;
      if (isMarked) visual.material.uniforms.colour.value.set(this.bodies.colourOf(object, css));
      else visual.material.uniforms.colour.value.copy(colour).multiplyScalar(ALBEDO);
    }
  }
}
