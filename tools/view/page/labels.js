// Labels of pairs in the scene: beside what they name, each with a line that leads to its pair.

const ANGLES = 12, RADII = [46, 90, 140, 200, 280]; // pixels from the pair to the label's nearest edge
const AGAIN_MS = 100; // between searches for places; labels follow their pairs in every frame
const STAYS = 0.5; // a label that covers none of its bodies moves only for a place that is better by this cost
const MARGIN = 4; // pixels between labels

// Costs of a place, by what the label would cover there.
const COST = { ownObjects: 4, otherObjects: 0.8, pair: 3, label: 20, outside: 40, leaderPerPixel: 1 / 250, leaderCrosses: 1 };

const overlap = (a, b) => Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) * Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
const areaOf = ({ left, top, right, bottom }) => Math.max(1, (right - left) * (bottom - top));
const around = ({ left, top, right, bottom }, by) => ({ left: left - by, top: top - by, right: right + by, bottom: bottom + by });

// Tells whether the segment from a to b passes the rectangle.
function passes(a, b, box) {
  let from = 0, to = 1;
  for (const [start, step, low, high] of [[a.x, b.x - a.x, box.left, box.right], [a.y, b.y - a.y, box.top, box.bottom]]) {
    if (Math.abs(step) < 1e-9) {
      if (start < low || start > high) return false;
      continue;
    }
    const [first, last] = [(low - start) / step, (high - start) / step].sort((one, other) => one - other);
    from = Math.max(from, first);
    to = Math.min(to, last);
  }
  return from <= to;
}

// The label's rectangle at a place, and the place's shift from the pair.
function boxAt({ x, y, width, height }, { angle, radius }) {
  const middle = { x: x + Math.cos(angle) * (radius + width / 2), y: y + Math.sin(angle) * (radius + height / 2) };
  return { left: middle.x - width / 2, right: middle.x + width / 2, top: middle.y - height / 2, bottom: middle.y + height / 2 };
}
// The point of a rectangle that is nearest to a point.
export const nearestIn = ({ left, top, right, bottom }, { x, y }) => ({ x: Math.min(right, Math.max(left, x)), y: Math.min(bottom, Math.max(top, y)) });

// Tells whether the label would cover a body that it names.
const covers = (label, place, objects) => objects.some(({ object, rectangle }) => label.objects.includes(object) && overlap(boxAt(label, place), rectangle) > 0);

const PLACES = RADII.flatMap((radius) => Array.from({ length: ANGLES }, (_, i) => ({ radius, angle: (2 * Math.PI * (i + 0.5)) / ANGLES })));

function costOf(label, place, { lines, objects, placed, size }) {
  const box = boxAt(label, place), share = (other) => overlap(box, other) / areaOf(box);
  const end = nearestIn(box, label);
  let cost = COST.leaderPerPixel * Math.hypot(end.x - label.x, end.y - label.y);
  const inside = { left: 0, top: 0, right: size.width, bottom: size.height };
  cost += COST.outside * (1 - share(inside));
  for (const { object, rectangle } of objects) cost += (label.objects.includes(object) ? COST.ownObjects : COST.otherObjects) * share(rectangle);
  for (const { a, b } of lines) if (passes(a, b, around(box, MARGIN))) cost += COST.pair;
  for (const other of placed) {
    cost += COST.label * share(around(other.box, MARGIN));
    if (passes(label, end, other.box)) cost += COST.leaderCrosses;
  }
  return cost;
}

// Chooses places for `labels`, the most important first: {key, x, y, width, height, objects} with the point that each
// belongs to, in pixels. `lines`: [{a, b}]; `objects`: [{object, rectangle}] of the screen. Keeps places between calls.
export class LabelPlaces {
  constructor() {
    this.places = new Map(); // by key
  }

  // Returns [{key, box, end}]: the rectangles, and the ends of the lines that lead from there.
  choose(labels, lines, objects, size, nowMs) {
    const isDue = !(nowMs - this.chosenMs < AGAIN_MS);
    if (isDue) this.chosenMs = nowMs;
    const placed = [];
    for (const label of labels) {
      const known = this.places.get(label.key);
      const cost = (place) => costOf(label, place, { lines, objects, placed, size });
      let place = known;
      if (!known || isDue) {
        const best = PLACES.map((each) => [cost(each), each]).reduce((one, other) => (other[0] < one[0] ? other : one));
        place = known && cost(known) < best[0] + (covers(label, known, objects) ? 0 : STAYS) ? known : best[1];
      }
      this.places.set(label.key, place);
      const box = boxAt(label, place);
      placed.push({ key: label.key, box, end: nearestIn(box, label) });
    }
    const keys = new Set(labels.map(({ key }) => key));
    for (const key of this.places.keys()) if (!keys.has(key)) this.places.delete(key);
    return placed;
  }
}
