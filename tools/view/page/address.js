// The content of a link, as tools/view/README.md lists it.

const text = new URLSearchParams(location.search);

export const asked = {
  time: text.has("t") ? Number(text.get("t")) : undefined,
  pairs: text.get("pairs")?.split(",").filter(Boolean) ?? [],
  filter: text.get("filter") ?? "",
  sort: text.get("sort"),
  camera: text.get("camera"),
  theme: text.get("theme"),
  robots: text.get("robots"),
  seen: text.get("seen"),
  hidden: text.get("hide")?.split(",").filter(Boolean) ?? [],
  shells: text.get("zones") !== "off",
  stops: text.get("stops") !== "off",
};

// The address that shows the same view again; the objects of a pair are joined by "~".
export function addressOf({ time, pairs, filter, sort, camera, theme, shells, stops, hidden, robots, seen }) {
  const all = new URLSearchParams();
  if (time !== undefined) all.set("t", time.toFixed(6));
  if (pairs.length) all.set("pairs", pairs.join(","));
  if (hidden.length) all.set("hide", hidden.join(","));
  if (filter) all.set("filter", filter);
  if (sort !== "lower") all.set("sort", sort);
  if (camera) all.set("camera", camera);
  if (theme) all.set("theme", theme);
  if (!shells) all.set("zones", "off");
  if (!stops) all.set("stops", "off");
  if (robots !== "bodies") all.set("robots", robots);
  if (seen !== "all") all.set("seen", seen);
  return `${location.origin}${location.pathname}?${all}`;
}
