// The looks of robots' links, as their URDFs have them, in place of the bodies that the queries use.
import * as THREE from "three";
import { matrixOf } from "./bodies.js";
import { css } from "./format.js";
import { plainMaterial } from "./solid_material.js";

const AGAIN_MS = 300; // while the server reads the meshes

export class Visuals extends THREE.Group {
  constructor(bodies) {
    super();
    this.bodies = bodies;
    this.visible = false;
  }

  // Shows them, or the bodies again. The meshes are fetched when they are first needed.
  async show(isWanted) {
    this.isWanted = isWanted;
    if (isWanted) await (this.loaded ??= this.load());
    this.visible = this.isWanted;
    this.bodies.hide(this.visible ? this.children.map(({ userData }) => userData.object) : []);
  }

  async load() {
    let found = null;
    while (!(found = await (await fetch("/visuals.json")).json())) await new Promise((done) => setTimeout(done, AGAIN_MS));
    const shapes = found.meshes.map(({ positions, triangles }) => {
      // Flat: meshes of files share few corners between faces that a person sees as one.
      const shape = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(positions, 3)).setIndex(triangles).toNonIndexed();
      shape.computeVertexNormals();
      return shape;
    });
    for (const { object, pose, mesh, colour } of found.visuals) {
      const visual = new THREE.Mesh(shapes[mesh], plainMaterial(this.bodies.lights));
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
      visual.visible = poses[object] !== undefined;
      if (!visual.visible) continue;
      visual.matrix.multiplyMatrices(poses[object], local);
      visual.matrixWorldNeedsUpdate = true;
      const isMarked = late.has(object) || chosen.has(object) || !colour;
      if (isMarked) visual.material.uniforms.colour.value.set(this.bodies.colourOf(object, css));
      else visual.material.uniforms.colour.value.copy(colour);
    }
  }
}
