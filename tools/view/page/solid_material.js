// The look of bodies: lit by a sky and by a sun behind the viewer, one colour per part. Bodies that hide moving ones are
// transparent as a whole: one material omits them, another draws only them, faintly.
import * as THREE from "three";
import { PLACED } from "./placements.js";

const EDGE_PER_SIZE = 8; // opacity of an edge, times the part's thickness as a share of half the view's height
const GHOST = 0.15; // opacity of faded bodies
const SKY = 1.8, SUN = 2.0; // irradiances
const GROUND = "#98a1ae";

// The parts that a material draws.
export const DRAWS = { solid: 1, faded: 2 };

// A part that is not drawn is put outside of the view.
const LEAVE_OUT = `
  if (isHidden() || isFaded() != (DRAWS == 2)) {
    gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    return;
  }`;

const vertexShader = `${PLACED}
  varying vec3 facing, colour;
  void main() {
    ${LEAVE_OUT}
    mat4 world = placed();
    facing = mat3(world) * normal;
    colour = ownColour();
    gl_Position = projectionMatrix * (viewMatrix * (world * vec4(position, 1.0)));
  }`;

// For fragment shaders: a lit colour, with the uniforms of lit().
const LIT = `uniform vec3 sun, ground;
  vec4 lit(vec3 colour, vec3 facing, float opacity) {
    vec3 normal = normalize(facing) * (gl_FrontFacing ? 1.0 : -1.0);
    vec3 light = ${SKY.toFixed(2)} * mix(ground, vec3(1.0), 0.5 + 0.5 * normal.z) + ${SUN.toFixed(2)} * max(0.0, dot(normal, sun));
    return sRGBTransferOETF(vec4(colour * light / 3.14159265, opacity));
  }`;
const lightsOf = (lights) => ({ ...lights, ground: { value: new THREE.Color(GROUND) } });

const fragmentShader = `${LIT}
  varying vec3 facing, colour;
  void main() {
    gl_FragColor = lit(colour, facing, DRAWS == 2 ? ${GHOST} : 1.0);
  }`;

// `lights`: {sun} as uniforms that all materials share.
export function solidMaterial(placements, lights, draws) {
  const ghost = draws === DRAWS.faded ? { transparent: true, depthWrite: false } : {};
  return new THREE.ShaderMaterial({
    ...ghost, vertexShader, fragmentShader, defines: { DRAWS: draws },
    uniforms: { ...lightsOf(lights), placements: { value: placements.texture } },
  });
}

// The material of one mesh with one colour, placed by its matrix; also from behind, since meshes for pictures are open.
export function plainMaterial(lights) {
  return new THREE.ShaderMaterial({
    side: THREE.DoubleSide, uniforms: { ...lightsOf(lights), colour: { value: new THREE.Color() } },
    vertexShader: `varying vec3 facing;
      void main() {
        facing = mat3(modelMatrix) * normal;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `${LIT} uniform vec3 colour; varying vec3 facing;
      void main() {
        gl_FragColor = lit(colour, facing, 1.0);
      }`,
  });
}

// Lines hide nothing: they have no depth where they are thinner than a pixel. The lines of small parts are faint, else
// a large cell would consist of lines.
export function edgeMaterial(placements, draws, colour) {
  return new THREE.ShaderMaterial({
    transparent: true, depthWrite: false, defines: { DRAWS: draws },
    uniforms: { placements: { value: placements.texture }, colour },
    vertexShader: `${PLACED}
      varying float strength;
      void main() {
        ${LEAVE_OUT}
        vec4 at = viewMatrix * (placed() * vec4(position, 1.0));
        strength = clamp(${EDGE_PER_SIZE.toFixed(1)} * ownSize() * projectionMatrix[1][1] / max(1e-6, -at.z), 0.05, 0.55);
        gl_Position = projectionMatrix * at;
        gl_Position.z -= 2e-5 * gl_Position.w;
      }`,
    fragmentShader: `uniform vec3 colour; varying float strength;
      void main() {
        gl_FragColor = vec4(colour, strength);
      }`,
  });
}
