// Zones as shells: the bodies of one group, enlarged by the zone's entry distance. They look like glass: visible at
// their rims, faint until the zone is active.
import * as THREE from "three";
import { matrixOf } from "./bodies.js";
import { css } from "./format.js";
import { everywhere, PLACED, Placements, trianglesOf } from "./placements.js";

const material = (placements) => new THREE.ShaderMaterial({
  uniforms: { placements: { value: placements.texture }, colour: { value: new THREE.Color() }, strength: { value: 0.2 } },
  transparent: true,
  depthWrite: false,
  vertexShader: `${PLACED}
    varying vec3 normalSeen, seen;
    void main() {
      mat4 world = placed();
      vec4 at = viewMatrix * (world * vec4(position, 1.0));
      normalSeen = mat3(viewMatrix) * (mat3(world) * normal);
      seen = -at.xyz;
      gl_Position = projectionMatrix * at;
    }`,
  fragmentShader: `uniform vec3 colour; uniform float strength; varying vec3 normalSeen, seen;
    void main() {
      float facing = abs(dot(normalize(normalSeen), normalize(seen)));
      gl_FragColor = vec4(colour, strength * (0.1 + pow(1.0 - facing, 3.0)));
    }`,
});

const world = new THREE.Matrix4(); // reused in every frame

export class ZoneShells extends THREE.Group {
  constructor(scene) {
    super();
    this.shells = scene.zones.map(({ shells }) => this.shellsOf(shells, scene.meshes));
    this.active = scene.zones.map(() => false);
    this.recolour();
  }

  shellsOf(parts, meshes) {
    if (!parts.length) return undefined;
    const placements = new Placements(parts.length);
    const solid = everywhere(new THREE.Mesh(trianglesOf(parts, meshes), material(placements)));
    solid.renderOrder = 5;
    this.add(solid);
    return { solid, placements, parts, local: parts.map(({ pose }) => matrixOf(pose)) };
  }

  // Moves the shells to their objects; `states` is CellState.zoneStates().
  update(bodies, states) {
    if (!this.visible) return;
    this.shells.forEach((shells, zone) => {
      shells?.parts.forEach(({ object }, i) => {
        shells.placements.place(i, bodies.isShown(object) ? world.multiplyMatrices(bodies.poses[object], shells.local[i]) : undefined);
      });
      if (this.active[zone] !== Boolean(states[zone].active)) {
        this.active[zone] = Boolean(states[zone].active);
        this.recolour();
      }
    });
  }

  recolour() {
    this.shells.forEach((shells, zone) => {
      const { colour, strength } = shells?.solid.material.uniforms ?? {};
      colour?.value.set(css(this.active[zone] ? "--alarm" : "--good"));
      if (strength) strength.value = this.active[zone] ? 0.26 : 0.14;
    });
  }
}
