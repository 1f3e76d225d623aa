// The look of bodies: lit by a sky and by a sun behind the viewer, one colour per part. Fragments between the viewer
// and moving parts are transparent: one material omits them, another draws only them, faintly.
import * as THREE from "three";
import { PLACED } from "./placements.js";

const EDGE_PER_SIZE = 8; // opacity of an edge, times the part's thickness as a share of half the view's height
const GHOST = 0.15; // opacity of transparent fragments
const SKY = 1.8, SUN = 2.0; // irradiances
const GROUND = "#98a1ae";

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

// `focus`: centre and radius of the moving parts; with a radius of 0 nothing is in front.
const CUT_OFF = `uniform vec4 focus; varying vec3 seen;
  bool isCutOff() {
    #if CUT
    vec3 centre = (viewMatrix * vec4(focus.xyz, 1.0)).xyz;
    vec3 axis = normalize(centre);
    float along = dot(seen, axis), away = length(seen - axis * along);
    bool inFront = along < length(centre) - 0.55 * focus.w && away < 1.15 * focus.w * along / length(centre);
    return inFront != (CUT == 2);
    #else
    return false;
    #endif
  }`;

const fragmentShader = `${CUT_OFF}
  uniform vec3 sun, ground;
  varying vec3 facing, colour;
  void main() {
    if (isCutOff()) discard;
    vec3 normal = normalize(facing) * (gl_FrontFacing ? 1.0 : -1.0);
    vec3 light = ${SKY.toFixed(2)} * mix(ground, vec3(1.0), 0.5 + 0.5 * normal.z) + ${SUN.toFixed(2)} * max(0.0, dot(normal, sun));
    gl_FragColor = sRGBTransferOETF(vec4(colour * light / 3.14159265, CUT == 2 ? ${GHOST} : 1.0));
  }`;

export const CUT = { nothing: 0, away: 1, ghost: 2 };

// `lights`: {focus, sun} as uniforms that all materials share.
export function solidMaterial(placements, lights, cut) {
  const ghost = cut === CUT.ghost ? { transparent: true, depthWrite: false } : {};
  // Cut bodies show their inside.
  const side = cut === CUT.away ? THREE.DoubleSide : THREE.FrontSide;
  return new THREE.ShaderMaterial({
    ...ghost, side, vertexShader, fragmentShader, defines: { CUT: cut },
    uniforms: { ...lights, placements: { value: placements.texture }, ground: { value: new THREE.Color(GROUND) } },
  });
}

// Lines hide nothing: they have no depth where they are thinner than a pixel. The lines of small parts are faint, else
// a large cell would consist of lines.
export function edgeMaterial(placements, lights, cut, colour) {
  return new THREE.ShaderMaterial({
    transparent: true, depthWrite: false, defines: { CUT: cut },
    uniforms: { ...lights, placements: { value: placements.texture }, colour },
    vertexShader: `${PLACED}
      varying vec3 seen;
      varying float strength;
      void main() {
        vec4 at = viewMatrix * placed() * vec4(position, 1.0);
        strength = clamp(${EDGE_PER_SIZE.toFixed(1)} * ownSize() * projectionMatrix[1][1] / max(1e-6, -at.z), 0.05, 0.55);
        seen = at.xyz;
        gl_Position = projectionMatrix * at;
        gl_Position.z -= 2e-5 * gl_Position.w;
      }`,
    fragmentShader: `${CUT_OFF} uniform vec3 colour; varying float strength;
      void main() {
        if (isCutOff()) discard;
        gl_FragColor = vec4(colour, strength);
      }`,
  });
}
