// What clearance-view's page says and draws of a robot that states how it stops, while it rests, moves away from a pin and
// then towards it; and what a click on its row, the key and the link do:
//   node stops.mjs URL
import { openBrowser, say } from "./browser.mjs";

const [url] = process.argv.slice(2);
const { browser, page, errors } = await openBrowser();
const facts = () => page.evaluate(() => {
  const { state, view } = window.clearance, { stopGhosts, lines, bodies } = view, name = (object) => bodies.cell.objects[object].name;
  const css = (colour) => getComputedStyle(document.documentElement).getPropertyValue(colour).trim();
  const row = document.querySelector("#separation tbody tr");
  return {
    ghosts: Object.fromEntries(stopGhosts.visible ? stopGhosts.children.filter(({ visible }) => visible).map(({ userData: { object }, matrix, material }) =>
      [name(object), { place: matrix.elements.slice(12, 15), x: matrix.elements.slice(0, 3), colour: `#${material.color.getHexString()}` }]) : []),
    lines: lines.shown.map(({ pair, level }) => ({ pair: state.pairs[pair.pair].name, level })),
    row: [...row.cells].map(({ textContent }) => textContent), kind: row.className,
    csv: window.clearance.csv().split("\r\n").map((line) => line.split(",")),
    plotted: document.getElementById("scaling").hidden ? "" : document.getElementById("plot-scaling-now").textContent,
    good: css("--good"), alarm: css("--alarm"), query: new URLSearchParams(location.search).get("stops"), pairs: new URLSearchParams(location.search).get("pairs"),
  };
});
// The row and the scene are drawn again within 125 ms.
async function drawn() {
  await page.waitForTimeout(400);
  const last = await page.evaluate(() => window.clearance.stands().frames + 3);
  await page.waitForFunction((frame) => window.clearance.stands().frames > frame, last);
}
const MOVES_FOR = 0.2; // s: a stop from rest is over sooner
const stop = (moves, clear) => page.waitForFunction(([least, isMoving, isClear]) => {
  const { validity, time, scaling } = window.clearance?.state.separation?.stops[0] ?? {};
  return validity === 2 && time > least === isMoving && (scaling === 1) === isClear;
}, [MOVES_FOR, moves, clear]);

await page.goto(url);
for (const [stage, moves, clear] of [["rests", false, true], ["moves away", true, true], ["comes near", true, false]]) {
  await stop(moves, clear);
  await drawn();
  say({ stage, ...(await facts()) });
}
await page.click("#separation tbody tr");
await page.keyboard.press("g");
await drawn();
say({ stage: "without", ...(await facts()) });
await page.goto(await page.evaluate(() => location.href));
await stop(true, false);
await drawn();
say({ stage: "linked", ...(await facts()), errors });
await browser.close();
