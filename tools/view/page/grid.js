// A half-space as a grid on its plane, which fades with distance; the body is below it.
import * as THREE from "three";

const SIZE = 60; // m

export function gridOn({ plane: [nx, ny, nz, offset], object, pose }, { pose: placed }) {
  const material = new THREE.ShaderMaterial({
    uniforms: { colour: { value: new THREE.Color() }, centre: { value: new THREE.Vector3() }, reach: { value: 4 } },
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
    vertexShader: `varying vec2 plane; varying vec3 world;
      void main() {
        plane = position.xy;
        world = (modelMatrix * vec4(position, 1.0)).xyz;
        gl_Position = projectionMatrix * viewMatrix * vec4(world, 1.0);
      }`,
    fragmentShader: `uniform vec3 colour, centre; uniform float reach; varying vec2 plane; varying vec3 world;
      float lines(float step) {
        vec2 at = plane / step, width = fwidth(at);
        vec2 off = abs(fract(at - 0.5) - 0.5) / width;
        return (1.0 - min(min(off.x, off.y), 1.0)) * clamp(0.6 - max(width.x, width.y), 0.0, 1.0);
      }
      void main() {
        float fade = 1.0 - smoothstep(0.6 * reach, 2.2 * reach, distance(world, centre));
        float strength = max(0.45 * lines(0.1), max(0.8 * lines(0.5), lines(2.5)));
        gl_FragColor = vec4(colour, fade * (0.07 + strength));
      }`,
  });
  const grid = new THREE.Mesh(new THREE.PlaneGeometry(SIZE, SIZE), material);
  const normal = new THREE.Vector3(nx, ny, nz);
  const local = new THREE.Matrix4().compose(
    normal.clone().multiplyScalar(offset),
    new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal),
    new THREE.Vector3(1, 1, 1));
  const [x, y, z, qx, qy, qz, qw] = pose;
  const part = new THREE.Matrix4().compose(new THREE.Vector3(x, y, z), new THREE.Quaternion(qx, qy, qz, qw), new THREE.Vector3(1, 1, 1));
  grid.matrixAutoUpdate = false;
  grid.renderOrder = -1;
  grid.userData.object = object;
  grid.follow = (placedNow) => {
    grid.matrix.copy(placedNow).multiply(part).multiply(local);
    grid.matrixWorldNeedsUpdate = true;
  };
  if (!placed) grid.follow(new THREE.Matrix4());
  return grid;
}
