// How bodies look: lit by a sky and by a sun behind the viewer, of one colour a part. What stands between the viewer and
// what moves is seen through: one material leaves those fragments out, another draws only them, faintly.
import * as THREE from "three";
import { PLACED } from "./placements.js";

const GHOST = 0.13; // opacity of what is seen through
const SKY = 1.7, SUN = 2.1; // irradiances
const GROUND = "#8a94a3";

const vertexShader = `${PLACED}
  varying vec3 facing, seen, colour;
  void main() {
    mat4 world = placed();
    vec4 at = viewMatrix * world * vec4(position, 1.0);
    facing = mat3(world) * normal;
    seen = at.xyz;
    colour = ownColour();
    gl_Position = projectionMatrix * at;
  }`;

// `focus`: centre and radius of what moves; a radius of 0: nothing is in front.
const fragmentShader = `uniform vec4 focus; uniform vec3 sun, ground;
  varying vec3 facing, seen, colour;
  bool inFront() {
    vec3 centre = (viewMatrix * vec4(focus.xyz, 1.0)).xyz;
    vec3 axis = normalize(centre);
    float along = dot(seen, axis), away = length(seen - axis * along);
    return along < length(centre) - 0.55 * focus.w && away < 1.15 * focus.w * along / length(centre);
  }
  void main() {
    #if CUT
    if (inFront() != (CUT == 2)) discard;
    #endif
    vec3 normal = normalize(facing);
    vec3 light = ${SKY} * mix(ground, vec3(1.0), 0.5 + 0.5 * normal.z) + ${SUN} * max(0.0, dot(normal, sun));
    gl_FragColor = vec4(colour * light / 3.14159265, CUT == 2 ? ${GHOST} : 1.0);
    #include <colorspace_fragment>
  }`;

export const CUT = { nothing: 0, away: 1, ghost: 2 };

// `lights`: {focus, sun} as uniforms that all materials share.
export function solidMaterial(placements, lights, cut) {
  const ghost = cut === CUT.ghost ? { transparent: true, depthWrite: false } : {};
  return new THREE.ShaderMaterial({
    ...ghost, vertexShader, fragmentShader, defines: { CUT: cut },
    uniforms: { ...lights, placements: { value: placements.texture }, ground: { value: new THREE.Color(GROUND) } },
  });
}

export function edgeMaterial(placements, colour) {
  return new THREE.ShaderMaterial({
    transparent: true,
    uniforms: { placements: { value: placements.texture }, colour },
    vertexShader: `${PLACED}
      void main() {
        gl_Position = projectionMatrix * viewMatrix * placed() * vec4(position, 1.0);
        gl_Position.z -= 2e-5 * gl_Position.w;
      }`,
    fragmentShader: "uniform vec3 colour; void main() { gl_FragColor = vec4(colour, 0.55); }",
  });
}
