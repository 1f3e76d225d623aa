// The places and colours of many parts in one texture that shaders read: a thousand parts then need one draw call and
// one texture update.
import * as THREE from "three";

const TEXELS = 5; // four columns of the matrix, the colour with the part's thickness: negative where it has faded
const HIDDEN = 1e9; // the thickness of parts that are not drawn, m
const A_ROW = 128; // parts per row
const LEAST = 1e-9; // m

// For vertex shaders: `owner` is the part's number. Products of matrices with vectors come first: a product of two
// matrices for each vertex would cost a processor that draws in software most of its time.
export const PLACED = `uniform highp sampler2D placements; attribute float owner;
  vec4 texel(int i) { int part = int(owner); return texelFetch(placements, ivec2(${TEXELS} * (part % ${A_ROW}) + i, part / ${A_ROW}), 0); }
  mat4 placed() { return mat4(texel(0), texel(1), texel(2), texel(3)); }
  vec3 ownColour() { return texel(4).rgb; }
  float ownSize() { return abs(texel(4).a); }
  bool isFaded() { return texel(4).a < 0.0; }
  bool isHidden() { return texel(4).a >= ${HIDDEN.toExponential()}; }`;

export class Placements {
  constructor(count) {
    const rows = Math.max(1, Math.ceil(count / A_ROW));
    this.texture = new THREE.DataTexture(new Float32Array(4 * TEXELS * A_ROW * rows), TEXELS * A_ROW, rows, THREE.RGBAFormat, THREE.FloatType);
    this.matrices = Array.from({ length: count }, () => new THREE.Matrix4().makeScale(0, 0, 0));
  }

  // `matrix`: world from part; undefined: the part is not drawn.
  place(part, matrix) {
    if (matrix) this.matrices[part].copy(matrix);
    else this.matrices[part].makeScale(0, 0, 0);
    this.matrices[part].toArray(this.texture.image.data, 4 * TEXELS * part);
    this.texture.needsUpdate = true;
  }
  // `thickness`: m. `look`: "solid", "faded" or "hidden".
  colour(part, colour, thickness, look) {
    const size = Math.max(LEAST, thickness);
    this.texture.image.data[4 * (TEXELS * part + 4) + 3] = { solid: size, faded: -size, hidden: HIDDEN }[look];
    colour.toArray(this.texture.image.data, 4 * (TEXELS * part + 4));
    this.texture.needsUpdate = true;
  }
}

function concatenated(arrays, Type) {
  const all = new Type(arrays.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const array of arrays) {
    all.set(array, at);
    at += array.length;
  }
  return all;
}

function withOwners(parts, count) {
  const owners = concatenated(parts.map((part, i) => new Float32Array(count(part)).fill(i)), Float32Array);
  return new THREE.BufferGeometry().setAttribute("owner", new THREE.BufferAttribute(owners, 1));
}
const attribute = (arrays) => new THREE.BufferAttribute(concatenated(arrays, Float32Array), 3);

// The triangles of all parts ({mesh}), each in its part's frame.
export function trianglesOf(parts, meshes) {
  const of = (name) => parts.map(({ mesh }) => meshes[mesh][name]);
  let first = 0;
  const indices = parts.map(({ mesh }) => {
    const shifted = meshes[mesh].triangles.map((corner) => corner + first);
    first += meshes[mesh].positions.length / 3;
    return shifted;
  });
  return withOwners(parts, ({ mesh }) => meshes[mesh].positions.length / 3)
    .setAttribute("position", attribute(of("positions")))
    .setAttribute("normal", attribute(of("normals")))
    .setIndex(new THREE.BufferAttribute(concatenated(indices, Uint32Array), 1));
}

// Sharp edges of parts, as segments.
export function edgesOf(parts, meshes) {
  return withOwners(parts, ({ mesh }) => meshes[mesh].edges.length / 3)
    .setAttribute("position", attribute(parts.map(({ mesh }) => meshes[mesh].edges)));
}

// Turns off culling, since only the shader knows the places.
export function everywhere(object) {
  object.frustumCulled = false;
  return object;
}
