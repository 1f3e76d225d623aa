// The axis of a plot of distances: round numbers at its ends, and ticks that a person reads at once.
import { roundUp } from "./format.js";

const LEAST = 1e-9; // of a length that is rounded
const EXCESS = 1.02; // of the end of the axis over the greatest value
const WITHOUT_VALUES = 100;

// The ends [low, high] of the axis for values from `least` to `most`; either may be missing. It holds 0.
export function axisOf(least, most) {
  const end = (length) => (length > 0 ? roundUp(Math.max(LEAST, length * EXCESS)) : 0);
  const low = -end(-least), high = end(most);
  return low === 0 && high === 0 ? [0, WITHOUT_VALUES] : [low === 0 ? 0 : low, high];
}

// Negative values, of bodies that overlap, have a tick of their own.
export function ticksOf(low, high) {
  if (low < 0 && high > 0) return [low, 0, high];
  return [low, (low + high) / 2, high];
}
