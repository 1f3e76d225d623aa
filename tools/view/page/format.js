// Figures as people read them.

export const mm = (metres, digits = 1) => {
  if (Number.isFinite(metres)) return (1e3 * metres).toFixed(digits).replace("-", "−");
  return metres === Infinity ? "∞" : metres === -Infinity ? "−∞" : "?";
};

export const signed = (value, digits = 3) => (Number.isFinite(value) ? (value >= 0 ? "+" : "−") + Math.abs(value).toFixed(digits) : "?");

// Contacts more than a quarter of an hour away are not shown.
export const contact = (seconds) => (Number.isNaN(seconds) ? "?" : seconds < 1000 ? seconds.toFixed(2) : "–");

export const milliseconds = (ns) => (ns < 0 ? "never" : (1e-6 * ns).toFixed(ns < 1e7 ? 1 : 0));

export const micro = (us) => (us < 1000 ? `${us.toFixed(us < 100 ? 1 : 0)} µs` : `${(us / 1000).toFixed(2)} ms`);

export const seconds = (s, digits = 3) => `${s.toFixed(digits)} s`;

// Changes text only where it is another: the browser lays out less.
export function put(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

export const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
