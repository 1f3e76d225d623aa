// Opens clearance-view's page and says which cell it shows, a line of JSON a step:
//   node changed_cell.mjs URL OBJECT [TIME...]
// Live (no TIME): says "ready" with the first report, then waits until the page shows an object of this name with reports.
// A recording: the same facts at each time, s after the first report.
import { openBrowser, say } from "./browser.mjs";

const [url, object, ...times] = process.argv.slice(2);
const { browser, page, errors } = await openBrowser();
const facts = () => page.evaluate(() => {
  const { scene, report, pairs, history } = window.clearance.state;
  const rows = (id) => [...document.querySelectorAll(`#${id} tbody tr`)].map(({ cells }) => [...cells].map(({ textContent }) => textContent));
  return {
    revision: scene.revision, of_this_cell: Number(report?.scene_revision) === Number(scene.revision), objects: scene.objects.map(({ name }) => name),
    contacts: rows("contacts"), attached: rows("attached"), kept: history.goesOn === true,
    unnamed: report?.pairs.filter(({ pair }) => !pairs[pair]).length,
  };
});
const hasReport = () => page.waitForFunction(() => window.clearance?.state.report !== undefined);

await page.goto(url);
await hasReport();
if (times.length === 0) {
  say({ ready: true, ...(await facts()) });
  await page.waitForFunction((name) => window.clearance?.state.report && window.clearance.state.scene.objects.some((each) => each.name === name), object);
  await page.waitForFunction(() => document.querySelector("#attached tbody tr") && document.querySelector("#contacts tbody tr"));
  say({ errors, ...(await facts()) });
}
for (const time of times.map(Number)) {
  await page.evaluate((to) => window.clearance.connection.set("playback.time", to), time);
  // Until it stands there, with the cell of that report: the page may be loaded anew.
  await page.waitForFunction((at) => {
    const { isAt, state } = window.clearance ?? {};
    return isAt?.(at) && Number(state.report.scene_revision) === Number(state.scene.revision);
  }, time);
  await page.waitForFunction(() => document.querySelectorAll("#contacts tbody tr").length === (window.clearance.state.report.contacts ?? []).length);
  const curve = await page.evaluate(async ([name, to]) => {
    const { pairs, scene } = window.clearance.state, pair = pairs.find(({ a, b }) => [a, b].some((id) => scene.objects[id].name === name));
    if (!pair) return null;
    const { pairs: curves } = await (await fetch(`/history.json?end=${to}&pairs=${pair.id}`)).json();
    return curves[pair.id]?.filter((value) => value !== null).length ?? 0;
  }, [object, time]);
  say({ time, errors, curve, moments: await page.evaluate(async () => (await (await fetch("/timeline.json")).json()).moments), ...(await facts()) });
}
await browser.close();
