// The keys and their actions; "?" shows this list.

const KEYS = [
  ["Space", "play or pause", (_, track) => track?.play()],
  ["ArrowLeft", "one report back; with Shift 1 s", (_, track, { shiftKey }) => (shiftKey ? track?.go(track.time - 1) : track?.step(-1))],
  ["ArrowRight", "one report forward; with Shift 1 s", (_, track, { shiftKey }) => (shiftKey ? track?.go(track.time + 1) : track?.step(1))],
  ["[", "slower", (_, track) => track?.faster(-1)],
  ["]", "faster", (_, track) => track?.faster(1)],
  ["w", "to the least distance", (_, track) => track?.worst()],
  ["m", "to the next marked moment", (_, track) => track?.nextMoment()],
  ["ArrowDown", "next pair of the table", (actions) => actions.row(1)],
  ["ArrowUp", "previous pair of the table", (actions) => actions.row(-1)],
  ["/", "filter the pairs", (actions) => actions.filter()],
  ["Escape", "choose nothing, and measure nothing", (actions) => actions.clear()],
  ["v", "look at the chosen pair; also two clicks on it", (actions) => actions.lookAtChosen()],
  ["f", "show the whole cell", (actions) => actions.fit()],
  ["1", "from above", (actions) => actions.look("top")],
  ["2", "from the front", (actions) => actions.look("front")],
  ["3", "from the side", (actions) => actions.look("side")],
  ["z", "zones as shells", (actions) => actions.shells()],
  ["g", "ghosts of robots where they stand if they are told to stop now", (actions) => actions.stops()],
  ["b", "robots: the bodies that are compared, their looks, or both", (actions) => actions.visuals()],
  ["p", "what cameras see: points and blind shells, points, or nothing", (actions) => actions.seen()],
  ["o", "list of objects and groups, to hide them", (actions) => actions.objects()],
  ["h", "hide or show the chosen objects", (actions) => actions.hide()],
  ["d", "measure the distance of two bodies by two clicks", (actions) => actions.measure()],
  ["c", "save the table as CSV", (actions) => actions.csv()],
  ["t", "dark or light", (actions) => actions.theme()],
  ["l", "link to this view", (actions) => actions.share()],
  ["s", "save a picture", (actions) => actions.picture()],
  ["?", "these keys", (actions) => actions.help()],
];

export function onKeys(actions, track) {
  document.querySelector("#keys dl").replaceChildren(...KEYS.flatMap(([key, text]) => [
    Object.assign(document.createElement("dt"), { textContent: key }),
    Object.assign(document.createElement("dd"), { textContent: text }),
  ]));
  document.addEventListener("keydown", (event) => {
    // The list of keys closes by Escape, as every dialog, and by the key that opens it.
    if (document.querySelector("dialog[open]") && event.key !== "?") return;
    const inField = event.target.matches("input, select");
    if (inField && event.key === "Escape") event.target.blur();
    if ((inField && event.key !== "Escape") || event.ctrlKey || event.metaKey || event.altKey) return;
    const name = event.key === " " ? "Space" : event.key;
    const found = KEYS.find(([key]) => key === name);
    if (!found) return;
    event.preventDefault();
    found[2](actions, track, event);
  });
}
