// The motion that a client has asked the daemon about: its links as ghosts along the path, and at the first instant that
// comes too near, with a colour of its own. Nothing here is a report.
import * as THREE from "three";
import { matrixOf } from "./bodies.js";
import { css } from "./format.js";

const PATH = 0.1, VIOLATION = 0.55; // opacities
const millimetres = (value) => (value === null ? "–" : `${(1e3 * value).toFixed(1)} mm`);

// A sentence about the answer: {level, text}. Level: "good", "near" or "alarm".
export function verdictOf({ client, status, reason, lower, violation }) {
  const who = `Asked by ${client}`;
  if (status !== "answered") return { level: "alarm", text: `${who}: nothing is known of this motion: ${reason}` };
  if (!violation) return { level: "good", text: `${who}: free, least distance at least ${millimetres(lower)}` };
  const { pair, margin, t, sure } = violation;
  const comes = sure ? "comes below" : "may come below";
  return { level: sure ? "alarm" : "near", text: `${who}: ${pair.join(" – ")} ${comes} ${millimetres(margin)} at ${t.toFixed(3)} s` };
}

export class AskedPath extends THREE.Group {
  constructor(bodies) {
    super();
    this.bodies = bodies;
  }

  // `asked` is the parameter asked.motion of the server, or null.
  show(asked) {
    this.asked = asked;
    for (const child of this.children) child.material.dispose();
    this.clear();
    if (!asked) return;
    const at = asked.violation?.frame;
    this.add(...this.ghosts(asked.frames.filter((_, i) => i !== at), "--accent", PATH));
    if (at !== undefined) this.add(...this.ghosts([asked.frames[at]], asked.violation.sure ? "--alarm" : "--near", VIOLATION));
  }

  // A mesh for each part, with a place for each frame.
  ghosts(frames, colour, opacity) {
    const { parts, ofObject, shapes, local } = this.bodies, places = new Map();
    for (const { links } of frames) {
      for (const [object, ...pose] of links) {
        const matrix = matrixOf(pose);
        for (const part of ofObject[object] ?? []) {
          if (!places.has(part)) places.set(part, []);
          places.get(part).push(new THREE.Matrix4().multiplyMatrices(matrix, local[part]));
        }
      }
    }
    return [...places].map(([part, matrices]) => {
      const material = new THREE.MeshBasicMaterial({ color: css(colour), transparent: true, opacity, depthWrite: false });
      const mesh = new THREE.InstancedMesh(shapes[parts[part].mesh], material, matrices.length);
      matrices.forEach((matrix, i) => mesh.setMatrixAt(i, matrix));
      mesh.renderOrder = 2;
      mesh.frustumCulled = false;
      return mesh;
    });
  }
  retheme() {
    this.show(this.asked);
  }
}
