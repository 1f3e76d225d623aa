// What sensors see: the points of their latest frames, where the sensors are, and the shells around robots within which
// the robots' own image is left out. Nothing there is an obstacle: a hand in a shell is not seen.
import * as THREE from "three";
import { matrixOf } from "./bodies.js";
import { css } from "./format.js";
import { everywhere, PLACED, Placements, trianglesOf } from "./placements.js";

// What is drawn of them.
export const SEEN_MODES = ["all", "points", "nothing"];

const POINT_PIXELS = 2.6;
const NOISE = 0.04; // m: points are drawn so much nearer to the viewer, else half of them would be hidden in what they show
const AROUND = 1.8; // m: the first view shows what is seen this close to the middle of the moving bodies
const AGAIN_MS = 300; // between questions for shells and places
const CAMERA = 0.14; // m: the length of the drawn sensor

// The edges of a pyramid that opens forward along z.
function cameraEdges() {
  const corners = [[-0.6, -0.45, 1], [0.6, -0.45, 1], [0.6, 0.45, 1], [-0.6, 0.45, 1]];
  const lines = corners.flatMap((corner, i) => [[0, 0, 0], corner, corner, corners[(i + 1) % 4]]);
  return new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(lines.flat().map((x) => CAMERA * x), 3));
}

const pointMaterial = () => new THREE.ShaderMaterial({
  uniforms: { colour: { value: new THREE.Color() } },
  vertexShader: `void main() {
      vec4 at = modelViewMatrix * vec4(position, 1.0);
      at.xyz *= 1.0 - min(0.5, ${NOISE.toFixed(3)} / max(1e-3, length(at.xyz)));
      gl_Position = projectionMatrix * at;
      gl_PointSize = ${POINT_PIXELS.toFixed(1)};
    }`,
  fragmentShader: "uniform vec3 colour; void main() { gl_FragColor = vec4(colour, 1.0); }",
});

// A shell has a thickness of its own: its corners are moved along their normals.
const shellMaterial = (placements, offset) => new THREE.ShaderMaterial({
  uniforms: { placements: { value: placements.texture }, colour: { value: new THREE.Color() } },
  transparent: true,
  depthWrite: false,
  vertexShader: `${PLACED}
    varying vec3 normalSeen, seen;
    void main() {
      if (isHidden()) {
        gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
        return;
      }
      mat4 world = placed();
      vec4 at = viewMatrix * (world * vec4(position + (ownSize() - ${offset.toFixed(6)}) * normal, 1.0));
      normalSeen = mat3(viewMatrix) * (mat3(world) * normal);
      seen = -at.xyz;
      gl_Position = projectionMatrix * at;
    }`,
  fragmentShader: `uniform vec3 colour; varying vec3 normalSeen, seen;
    void main() {
      float facing = abs(dot(normalize(normalSeen), normalize(seen)));
      gl_FragColor = vec4(colour, 0.06 + 0.34 * pow(1.0 - facing, 2.0));
    }`,
});

const world = new THREE.Matrix4(); // reused in every frame

export class Seen extends THREE.Group {
  // `bodies` tells where robots are, and what a person has hidden.
  constructor(scene, bodies) {
    super();
    this.cell = scene;
    this.bodies = bodies;
    this.changes = 0;
    this.mode = SEEN_MODES[0];
    this.status = []; // by sensor: the server's /sensors.json
    this.sensors = scene.sensors.map(() => this.makeSensor());
    this.makeShells(scene);
  }

  makeSensor() {
    const points = new THREE.Points(new THREE.BufferGeometry(), pointMaterial());
    const place = new THREE.LineSegments(cameraEdges(), new THREE.LineBasicMaterial());
    place.matrixAutoUpdate = false;
    points.visible = place.visible = false;
    this.add(everywhere(points), everywhere(place));
    return { points, place, ns: 0 };
  }
  makeShells({ blind_shells: { parts, offset }, meshes }) {
    this.parts = parts;
    if (!parts.length) return;
    this.placements = new Placements(parts.length);
    this.local = parts.map(({ pose }) => matrixOf(pose));
    this.shells = everywhere(new THREE.Mesh(trianglesOf(parts, meshes), shellMaterial(this.placements, offset)));
    this.shells.renderOrder = 6;
    this.add(this.shells);
  }

  // A message of /clearance/seen; `ns`: its stamp.
  take({ sensor, positions }, ns) {
    const found = this.sensors[sensor];
    if (!found) return;
    found.points.geometry.dispose();
    found.points.geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(positions, 3));
    found.ns = ns;
    ++this.changes;
  }

  // Asks for shells and places now and then, while the page is shown.
  async ask(nowMs) {
    if (!this.sensors.length || this.isAsking || nowMs - this.askedMs < AGAIN_MS || document.hidden) return;
    this.isAsking = true;
    this.askedMs = nowMs;
    try {
      const text = await (await fetch("/sensors.json")).text();
      if (text !== this.text) {
        this.text = text;
        this.status = JSON.parse(text);
        ++this.changes;
      }
    } catch {
      // the server has ended: the page says so
    }
    this.isAsking = false;
  }

  // A box around the points that are close to a place.
  boundsNear(centre) {
    const box = new THREE.Box3(), point = new THREE.Vector3();
    for (const { points } of this.sensors) {
      const places = points.geometry.getAttribute("position");
      for (let i = 0; i < (places?.count ?? 0); ++i) {
        if (point.fromBufferAttribute(places, i).distanceTo(centre) < AROUND) box.expandByPoint(point);
      }
    }
    return box;
  }

  // The age of a sensor's points, ns, and whether they are too old.
  age(sensor, timeNs) {
    const { ns } = this.sensors[sensor];
    return ns ? { ns: timeNs - ns, isLate: Math.abs(timeNs - ns) > this.cell.sensors[sensor].age_limit_ns + 1e9 } : { ns: -1, isLate: true };
  }

  update(timeNs) {
    this.visible = this.mode !== "nothing";
    if (!this.visible) return;
    this.sensors.forEach(({ points, place, ns }, i) => {
      const { object } = this.cell.sensors[i], isOff = this.bodies.off.has(object);
      const colour = this.age(i, timeNs).isLate ? css("--lost") : this.bodies.chosen.has(object) ? css("--accent") : css("--seen");
      const pose = this.status[i]?.pose;
      points.visible = ns > 0 && !isOff;
      place.visible = Boolean(pose) && !isOff;
      points.material.uniforms.colour.value.setStyle(colour, THREE.LinearSRGBColorSpace);
      place.material.color.set(colour);
      if (pose) place.matrix.copy(matrixOf(pose));
      place.matrixWorldNeedsUpdate = true;
    });
    this.updateShells();
  }

  // Each link has the thickest shell that a sensor makes blind.
  updateShells() {
    if (!this.shells) return;
    this.shells.visible = this.mode === SEEN_MODES[0];
    this.shells.material.uniforms.colour.value.set(css("--lost"));
    this.parts.forEach(({ object }, i) => {
      const thickness = this.thicknessOf(object), isShown = thickness > 0 && this.bodies.isShown(object);
      this.placements.colour(i, this.shells.material.uniforms.colour.value, thickness, isShown ? "solid" : "hidden");
      this.placements.place(i, isShown ? world.multiplyMatrices(this.bodies.poses[object], this.local[i]) : undefined);
    });
  }
  thicknessOf(object) {
    return Math.max(0, ...this.status.map(({ shells }) => shells[object] ?? 0));
  }
}
