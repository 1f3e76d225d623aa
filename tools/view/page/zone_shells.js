// Zones as shells: the bodies of one group of a zone, enlarged by what the zone is entered below. Like glass: seen at
// their rims, faint until the zone is active.
import * as THREE from "three";
import { batch, matrixOf } from "./bodies.js";
import { css } from "./format.js";

const material = () => new THREE.ShaderMaterial({
  uniforms: { colour: { value: new THREE.Color() }, strength: { value: 0.2 } },
  transparent: true,
  depthWrite: false,
  vertexShader: `#include <common>
    #include <batching_pars_vertex>
    varying vec3 normalSeen, seen;
    void main() {
      #include <batching_vertex>
      mat4 placed = viewMatrix * batchingMatrix;
      vec4 at = placed * vec4(position, 1.0);
      normalSeen = mat3(placed) * normal;
      seen = -at.xyz;
      gl_Position = projectionMatrix * at;
    }`,
  fragmentShader: `uniform vec3 colour; uniform float strength; varying vec3 normalSeen, seen;
    void main() {
      float facing = abs(dot(normalize(normalSeen), normalize(seen)));
      gl_FragColor = vec4(colour, strength * (0.1 + pow(1.0 - facing, 3.0)));
    }`,
});

export class ZoneShells extends THREE.Group {
  constructor(scene) {
    super();
    this.shells = scene.zones.map(({ shells }) => this.shellsOf(shells, scene.meshes));
    this.active = scene.zones.map(() => false);
    this.recolour();
  }

  shellsOf(parts, meshes) {
    if (!parts.length) return undefined;
    const solid = batch(parts, meshes, material());
    solid.renderOrder = 5;
    this.add(solid);
    return { solid, parts, local: parts.map(({ pose }) => matrixOf(pose)) };
  }

  // To where the objects are; `states` as CellState.zoneStates().
  update(poses, states) {
    if (!this.visible) return;
    this.shells.forEach((shells, zone) => {
      shells?.parts.forEach(({ object }, i) => {
        shells.solid.setVisibleAt(i, poses[object] !== undefined);
        if (poses[object]) shells.solid.setMatrixAt(i, poses[object].clone().multiply(shells.local[i]));
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
