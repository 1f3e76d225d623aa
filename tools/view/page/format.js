// Figures for people, and the knowledge of a pair's distance.

// PairStatus of monitor/interface/report.hpp.
export const STATUS = ["converged", "touching", "overlapping", "iteration_limit", "carried", "stale", "unknown", "absent"];
const STALE = STATUS.indexOf("stale");
export const isKnown = (pair) => pair.status < STALE;

export const mm = (metres, digits = 1) => {
  if (Number.isFinite(metres)) return (1e3 * metres).toFixed(digits).replace("-", "−");
  return metres === Infinity ? "∞" : metres === -Infinity ? "−∞" : "?";
};

export const signed = (value, digits = 3) => (Number.isFinite(value) ? (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(digits) : "?");

// Contacts more than a quarter of an hour away are not shown.
export const contact = (seconds) => (Number.isNaN(seconds) ? "?" : seconds < 1000 ? seconds.toFixed(2) : "–");

export const milliseconds = (ns) => (ns < 0 ? "never" : (1e-6 * ns).toFixed(ns < 1e7 ? 1 : 0));

// The age of an input: that of one whose age the daemon has forgotten is above a hundred years.
export const age = (ns) => (ns < 0 ? "never seen" : ns >= 3155760000000000000 ? "an unknown time" : `${milliseconds(ns)} ms`);

export const micro = (us) => (us < 1000 ? `${us.toFixed(us < 100 ? 1 : 0)} µs` : `${(us / 1000).toFixed(2)} ms`);

export const seconds = (s, digits = 3) => `${s.toFixed(digits)} s`;

// "1 pair", "2 pairs".
export const counted = (count, singular, plural = `${singular}s`) => `${count} ${Number(count) === 1 ? singular : plural}`;

// Sets the text only when it has changed, which saves the browser work.
export function put(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// 1, 2 or 5 times a power of ten, not below the value.
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(Math.max(value, 1e-12)));
  return [1, 2, 5, 10].map((each) => each * power).find((each) => each >= value * 0.999);
}

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
