// Opens clearance-view's page in Debian's Chromium and says what it shows, a line of JSON a step:
//   node page.mjs URL FOLDER live|recording|separation
// Pictures go into FOLDER.
import { openBrowser, say } from "./browser.mjs";

const [url, folder, what] = process.argv.slice(2);
const { browser, page, errors } = await openBrowser();
const picture = (name) => page.screenshot({ path: `${folder}/${name}.png` });
const minimum = () => page.$eval("#minimum", ({ dataset }) => ({
  cycle: Number(dataset.cycle), distance: dataset.distance === "" ? null : Number(dataset.distance),
  pair: document.getElementById("minimum-pair").textContent, value: document.getElementById("minimum-value").textContent,
}));
const alarm = () => page.$eval("#alarm", (box) => (box.hidden ? "" : box.textContent));

async function live() {
  await page.waitForFunction(() => window.clearance?.shownFor() > 1 && document.getElementById("minimum").dataset.distance !== "");
  const samples = [];
  for (let i = 0; i < 10; ++i) {
    samples.push(await minimum());
    await page.waitForTimeout(50);
  }
  await page.click("#pair-table tbody tr:first-child");
  await page.waitForTimeout(300);
  await picture("live-light");
  await page.keyboard.press("t");
  await page.setViewportSize({ width: 820, height: 1180 });
  await page.waitForTimeout(300);
  await picture("live-dark-tablet");
  say({
    samples, chosen: await page.$$eval("tr.chosen", (rows) => rows.length), rows: await page.$$eval("#pair-table tbody tr", (rows) => rows.length),
    zones: await page.$$eval("#zones .chip:not(.more)", (chips) => chips.map(({ textContent }) => textContent)),
    theme: await page.$eval("html", ({ dataset }) => dataset.theme), alarm: await alarm(), address: page.url(), errors,
  });
  await page.waitForFunction(() => document.getElementById("alarm").textContent.includes("clearanced has ended"));
  await page.setViewportSize({ width: 1440, height: 900 });
  await page.waitForTimeout(300);
  await picture("ended");
  say({ ended: await alarm(), minimum: await minimum(), frozen: await page.$eval("#scene", ({ classList }) => classList.contains("frozen")) });
}

// What the table of separations says once it knows.
async function separation() {
  await page.waitForFunction(() => /\d/.test(document.querySelector("#separation tbody td:nth-child(3)")?.textContent ?? ""));
  const cells = (name) => page.$$eval(`#separation ${name}`, (all) => all.map(({ textContent }) => textContent));
  await picture("separation");
  const measured = await cells("tbody td");
  await page.waitForFunction(() => document.querySelector("#separation tbody tr").className === "lost");
  say({ heads: await cells("th"), measured, lost: await cells("tbody td"), errors });
}

// The recording stands still where the page says.
const settled = (time) => page.waitForFunction((at) => window.clearance?.isAt(at), time);
const standsStill = () => page.waitForFunction(() => window.clearance?.isAt(parseFloat(document.getElementById("time").textContent)));
const shownTime = () => page.$eval("#time", ({ textContent }) => parseFloat(textContent));

// Clicks where the middle of an object is; what the table is then filtered by.
async function clickOn(name) {
  const at = await page.evaluate((object) => {
    const { bodies, camera, size } = window.clearance.view;
    const middle = bodies.bounds(({ name }) => name === object).getCenter(camera.position.clone()).project(camera);
    const box = document.getElementById("view").getBoundingClientRect();
    return [box.left + (0.5 + 0.5 * middle.x) * size.width, box.top + (0.5 - 0.5 * middle.y) * size.height];
  }, name);
  await page.keyboard.press("Escape");
  await page.evaluate(() => (document.getElementById("labels").hidden = true));
  await page.mouse.click(...at);
  return page.$eval("#filter", ({ value }) => value);
}

async function recording() {
  await settled(0);
  const timeline = await (await fetch(new URL("/timeline.json", url))).json();
  const closest = timeline.moments.find(({ kind }) => kind === "closest");
  await page.click("#worst");
  await settled(closest.time);
  // The least distance was found in one report. Waits until the page shows that report.
  await page.waitForFunction(() => Math.abs(window.clearance.stands().report - window.clearance.stands().time) < 1e6);
  await settled(closest.time);
  const worst = await minimum();
  await picture("worst-moment");
  // A report further; back, where the worst is the last.
  const further = closest.time < timeline.duration - 1e-6 ? 1 : -1;
  await page.keyboard.press(further > 0 ? "ArrowRight" : "ArrowLeft");
  // The cycle that is shown next may be a later one: a busy machine leaves reports out of a recording.
  await page.waitForFunction(([cycle, by]) => (Number(document.getElementById("minimum").dataset.cycle) - cycle) * by > 0, [worst.cycle, further]);
  await page.click("#pair-table tbody tr:first-child");
  const box = await (await page.$("#track")).boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.75 * box.width, box.y + 20, { steps: 4 });
  await page.mouse.up();
  // Places in between are shown as well, and one of them may stand still for a moment: the last one is near 0.73 of the recording.
  await page.waitForFunction(([time, near]) => Math.abs(parseFloat(document.getElementById("time").textContent) - time) < near,
    [0.73 * timeline.duration, 0.05 * timeline.duration]);
  await standsStill();
  const share = await page.evaluate(() => { document.getElementById("share").click(); return location.href; });
  const dragged = Number(new URL(share).searchParams.get("t"));
  await page.keyboard.press("w");
  await settled(closest.time);
  const clicked = await clickOn("left");
  await page.goto(share);
  await settled(dragged);
  await picture("shared-link");
  say({ timeline, worst, dragged, share, clicked, again: await shownTime(), chosen: await page.$$eval("tr.chosen", (rows) => rows.length), errors });
  await page.keyboard.press("Space");
  await page.waitForFunction((time) => parseFloat(document.getElementById("time").textContent) > time + 0.1, dragged);
  say({ played: await shownTime(), framesPerSecond: await page.evaluate(() => window.clearance.framesPerSecond()) });
}

try {
  if (what === "live") await page.goto(url).then(live);
  else if (what === "separation") await page.goto(url).then(separation);
  else await page.goto(`${url}?t=0`).then(recording);
} catch (error) {
  const stands = await page.evaluate(() => ({ ...window.clearance?.stands(), shown: { ...document.getElementById("minimum").dataset } })).catch(({ message }) => message);
  say({ failed: error.stack, errors, stands });
  await picture("failed").catch(() => {});
  process.exitCode = 1;
}
await browser.close();
