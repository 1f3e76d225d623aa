// Finds the bodies that hide moving ones from the viewer, by rays from the eye to points of the moving bodies. Such a
// body fades as a whole.
import * as THREE from "three";

const MOST_OBJECTS = 24; // moving objects with points; of more, a selection
const INNER = 0.6; // points lie at this share of an object's half extents
const HIDES = 0.12, HIDES_STILL = 0.05; // share of the points that a body hides, to fade and to stay so

// The centre of a box, and eight points within it.
function pointsOf(box) {
  const centre = box.getCenter(new THREE.Vector3()), half = box.getSize(new THREE.Vector3()).multiplyScalar(0.5 * INNER);
  const corner = (i) => new THREE.Vector3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).multiply(half).add(centre);
  return [centre, ...Array.from({ length: 8 }, (_, i) => corner(i))];
}

// `moving`: boxes in the world; `still`: [{object, shape, matrix}] with their geometries; `faded`: the objects that have
// faded. Returns the objects of `still` that hide too much.
export function hidingObjects(eye, moving, still, faded) {
  const step = Math.max(1, moving.length / MOST_OBJECTS);
  const points = Array.from({ length: Math.min(moving.length, MOST_OBJECTS) }, (_, i) => moving[Math.floor(i * step)]).flatMap(pointsOf);
  const counts = new Map(), probe = new THREE.Mesh(), raycaster = new THREE.Raycaster();
  const bounds = still.map(({ shape, matrix }) => shape.boundingSphere.clone().applyMatrix4(matrix));
  for (const point of points) {
    const direction = point.clone().sub(eye);
    raycaster.far = direction.length();
    raycaster.set(eye, direction.normalize());
    const hit = new Set();
    still.forEach(({ object, shape, matrix }, i) => {
      if (hit.has(object) || !raycaster.ray.intersectsSphere(bounds[i])) return;
      probe.geometry = shape;
      probe.matrixWorld = matrix;
      const found = [];
      probe.raycast(raycaster, found);
      if (found.length) hit.add(object);
    });
    for (const object of hit) counts.set(object, (counts.get(object) ?? 0) + 1);
  }
  const isHiding = ([object, count]) => count > (faded.has(object) ? HIDES_STILL : HIDES) * points.length;
  return new Set([...counts].filter(isHiding).map(([object]) => object));
}
