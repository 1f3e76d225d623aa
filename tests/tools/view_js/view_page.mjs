// What the page makes of its window, its keys and its scene, a line of JSON a step:
//   node view_page.mjs URL STEP...
// A step is one of the functions below.
import { openBrowser, say } from "./browser.mjs";

const [url, ...steps] = process.argv.slice(2);
const { browser, page, errors } = await openBrowser({ width: 1200, height: 800 });
const ready = () => page.waitForFunction(() => window.clearance?.stands().ready && window.clearance.state.report && window.clearance.view.drawn > 1);

// Waits for frames of the page.
async function frames(count) {
  const first = await page.evaluate(() => window.clearance.stands().frames);
  await page.waitForFunction((last) => window.clearance.stands().frames > last, first + count);
}

// Frames that a person saw empty: a canvas gets its size, which empties it, and is shown before it is drawn again.
async function resolution() {
  await page.evaluate(() => {
    const { renderer } = window.clearance.view, { setSize, render } = renderer;
    const seen = (window.seen = { sizes: 0, blank: 0 });
    let isBlank = false;
    renderer.setSize = (...all) => (++seen.sizes, (isBlank = true), setSize.apply(renderer, all));
    renderer.render = (...all) => (renderer.getRenderTarget() || (isBlank = false), render.apply(renderer, all));
    const shown = new MessageChannel(); // its task runs after the frame has been shown
    shown.port1.onmessage = () => (seen.blank += isBlank ? 1 : 0);
    const each = () => (requestAnimationFrame(each), shown.port2.postMessage(0));
    each();
  });
  const changed = async (change) => {
    const sizes = await page.evaluate(() => window.seen.sizes);
    await change();
    await page.waitForFunction((before) => window.seen.sizes > before, sizes);
    await frames(3);
  };
  for (const width of [1000, 1300]) await changed(() => page.setViewportSize({ width, height: 800 }));
  await changed(() => page.evaluate(() => Object.assign(window.clearance.view, { took: 1000, sinceAdapted: 100, sharpness: 1 }) && 0));
  return page.evaluate(() => window.seen);
}

// Where moving bodies are in the frames of some seconds: the largest coordinate, 1 at the view's edge.
async function firstView() {
  let largest = 0;
  for (let i = 0; i < 12; ++i) {
    await page.waitForTimeout(400);
    largest = Math.max(largest, await page.evaluate(() => {
      const { view } = window.clearance, { min, max } = view.bodies.bounds(({ fixed }) => !fixed), corner = view.camera.position.clone();
      return Math.max(...Array.from({ length: 8 }, (_, k) => {
        corner.set(k & 1 ? max.x : min.x, k & 2 ? max.y : min.y, k & 4 ? max.z : min.z).project(view.camera);
        return Math.max(Math.abs(corner.x), Math.abs(corner.y));
      }));
    }));
  }
  const box = await (await page.$("#view")).boundingBox();
  await page.mouse.move(box.x + 0.1 * box.width, box.y + 0.1 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.1 * box.height, { steps: 3 });
  await page.mouse.up();
  const place = () => page.evaluate(() => window.clearance.view.place);
  let moved = "";
  for (let same = 0; same < 4;) {
    await page.waitForTimeout(500);
    const now = await place(); // until the view has come to rest
    same = now === moved ? same + 1 : 0;
    moved = now;
  }
  await page.waitForTimeout(2000);
  // The last of its motion may still change a rounded number. A view that grows moves much farther.
  const numbers = (text) => text.split(",").map(Number), before = numbers(moved), after = numbers(await place());
  return { largest, stays: before.every((each, i) => Math.abs(each - after[i]) < 0.01) };
}

// How the closest pair lies in the view by the key, and by two clicks on its row: the middle of its gap, and the gap's
// length. Each is measured at once, since the pair moves on.
async function look() {
  await page.waitForFunction(() => document.querySelector("#pair-table tbody tr"));
  return page.evaluate(() => {
    const { view, state } = window.clearance;
    const lies = () => {
      view.controls.update();
      view.camera.updateMatrixWorld();
      const pair = state.minimum();
      const at = ({ x, y, z }) => view.camera.position.clone().set(x, y, z).project(view.camera);
      const [a, b] = [at(pair.witness_a), at(pair.witness_b)];
      return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, length: Math.hypot(a.x - b.x, a.y - b.y) };
    };
    const press = (key) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    const found = {};
    press("v");
    found.key = lies();
    press("f");
    found.far = lies();
    const row = [...document.querySelectorAll("#pair-table tbody tr")].find(({ dataset }) => Number(dataset.pair) === state.minimum().pair);
    row.dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
    found.clicks = lies();
    return found;
  });
}

// Whether labels cover the bodies that they name, or each other, and how many lines lead from them: in the frame in
// which their places were chosen, since a label follows its moving pair until the next choice.
async function labels() {
  await frames(5);
  return page.evaluate(async () => {
    const { view } = window.clearance, { lines, size } = view, before = lines.places.chosenMs;
    while (lines.places.chosenMs === before) await new Promise(requestAnimationFrame);
    const boxes = [...document.querySelectorAll(".label")].filter(({ hidden }) => !hidden).map((label) => {
      const { left, top, right, bottom } = label.getBoundingClientRect(), origin = document.getElementById("view").getBoundingClientRect();
      return { pair: Number(label.dataset.pair), left: left - origin.left, top: top - origin.top, right: right - origin.left, bottom: bottom - origin.top };
    });
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const covers = boxes.filter((box) => view.cell.pairs[box.pair].slice(0, 2).some((object) =>
      lines.rectangles.some((each) => each.object === object && overlap(box, each.rectangle)))).length;
    const meet = boxes.flatMap((a, i) => boxes.slice(i + 1).filter((b) => overlap(a, b))).length;
    const leaders = [...document.querySelectorAll("#labels line")].filter(({ style }) => style.display !== "none");
    return { labels: boxes.length, covers, meet, leaders: leaders.length, size };
  });
}

// The objects that have faded, and whether the materials draw a part of a body.
async function fading() {
  await page.waitForFunction(() => window.clearance.view.bodies.faded.size > 0);
  return page.evaluate(() => {
    const { bodies } = window.clearance.view;
    return { faded: [...bodies.faded].map((object) => bodies.cell.objects[object].name), veil: bodies.veil.visible };
  });
}

// The header at several widths, and the right column at the height of a small screen.
async function layout() {
  const found = { rows: [] };
  for (const width of [1440, 1180, 1024, 820]) {
    await page.setViewportSize({ width, height: 800 });
    await page.waitForTimeout(500);
    found.rows.push(await page.evaluate(() => {
      const header = document.querySelector("header"), boxes = [...header.children].map((each) => each.getBoundingClientRect());
      return { width: innerWidth, height: header.clientHeight, overflow: header.scrollWidth - header.clientWidth,
        overlaps: boxes.slice(1).filter(({ left }, i) => left < boxes[i].right - 1).length, last: innerWidth - boxes.at(-1).right };
    }));
  }
  await page.setViewportSize({ width: 1440, height: 800 });
  await page.click("#pair-table tbody tr:first-child");
  await page.waitForTimeout(500);
  found.column = await page.evaluate(() => {
    const aside = document.querySelector("aside"), rows = document.querySelector(".rows").getBoundingClientRect();
    const full = [...document.querySelectorAll("#pair-table tbody tr")].filter((row) => row.getBoundingClientRect().bottom <= rows.bottom + 1);
    return { overflow: aside.scrollHeight - aside.clientHeight, rows: full.length };
  });
  return found;
}

// How the closest pair, which overlaps, is told; the view's size with and without the floor, and how far the camera is; labels, and heads of
// the table that are wider than their columns; what a link has, and what is shown when it is opened.
async function crowded() {
  await page.waitForFunction(() => window.clearance.state.minimum());
  await frames(5);
  const found = await page.evaluate(() => {
    const { state, view } = window.clearance, pair = state.minimum(), width = ({ min, max }) => max.x - min.x;
    return { distance: pair.distance, level: state.levelOf(pair), header: document.getElementById("minimum").className, lines: view.lines.shown.length,
      whole: width(view.bodies.bounds()), fit: width(view.bodies.boundsWithoutFloors()), away: view.camera.position.distanceTo(view.controls.target) };
  });
  found.heads = [];
  for (const width of [1440, 1100, 1000]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(400);
    found.heads.push(await page.$$eval("#pair-table th", (heads) => heads.filter((head) => head.scrollWidth > head.clientWidth + 1).map(({ textContent }) => textContent)));
  }
  await frames(5);
  found.labels = await page.$$eval(".label", (all) => all.filter(({ hidden }) => !hidden).map(({ offsetWidth }) => offsetWidth));
  await page.evaluate(() => window.clearance.view.on.pairChosen(window.clearance.state.minimum().pair));
  await page.keyboard.press("l");
  const place = () => page.evaluate(() => window.clearance.view.place);
  const [address, before] = [await page.evaluate(() => location.href), await place()];
  await page.goto(address);
  await ready();
  await page.waitForFunction((place) => window.clearance.view.place === place, before).catch(() => {}); // otherwise the two differ
  found.link = { address, same: before === (await place()), chosen: await page.$$eval("tr.chosen", (rows) => rows.length) };
  return found;
}

// What the address asks to be drawn of robots, once it is; the address then, and the colour of each object.
async function robots() {
  await page.waitForFunction(() => window.clearance.view.visuals.visible && window.clearance.view.isReady);
  return page.evaluate(() => {
    const { visuals, bodies } = window.clearance.view;
    return { mode: visuals.mode, looks: visuals.children.length, text: document.getElementById("visuals").textContent, address: new URLSearchParams(location.search).get("robots"),
      colours: Object.fromEntries(bodies.cell.objects.map(({ name }, object) => [name, bodies.colourOf(object, (theme) => theme)])) };
  });
}

async function keys() {
  const isOpen = () => page.$eval("#keys", ({ open }) => open);
  await page.keyboard.press("?");
  const opened = await isOpen();
  await page.keyboard.press("Escape");
  const closed = !(await isOpen());
  return { opened, closed };
}

async function ticks() {
  return page.evaluate(async () => {
    const { axisOf, ticksOf } = await import("/axis.js");
    const { low, high } = (({ min, max }) => ({ low: min, high: max }))(window.clearance.plots.minimum.plot.scales.y);
    const of = (least, most) => ticksOf(...axisOf(least, most));
    return { shown: ticksOf(low, high), mixed: of(-30, 300), negative: of(-30, -5), positive: of(5, 300) };
  });
}

// The chips once the header has drawn the states of all zones.
async function zones() {
  await page.waitForFunction(() => {
    const { zones: known, scene } = window.clearance.state, [first] = document.querySelectorAll("#zones .chip");
    return known.size === scene.zones.length && first && !first.textContent.includes("not known");
  });
  return page.$$eval("#zones .chip", (chips) => chips.map(({ textContent, className, title }) => ({ text: textContent, kind: className, title })));
}

// What the header says of the least distance once the daemon has reported.
async function inputs() {
  await page.waitForFunction(() => window.clearance.state.report && /have|are/.test(document.getElementById("minimum-pair").textContent));
  return { minimum: await page.$eval("#minimum-pair", ({ textContent }) => textContent) };
}

// The switch between bodies, visual meshes, and both: the links with visual shapes, the triangles and colour of each, which
// objects' bodies are replaced, and whether these are seen as glass.
async function visuals() {
  const now = () => page.evaluate(() => {
    const { visuals, bodies } = window.clearance.view;
    return { text: document.getElementById("visuals").textContent, visible: visuals.visible, replaced: bodies.replaced.size, glass: bodies.glass.visible };
  });
  await page.keyboard.press("b");
  await page.waitForFunction(() => window.clearance.view.visuals.visible);
  const shown = await page.evaluate(() => {
    const { visuals, bodies } = window.clearance.view, name = (object) => bodies.cell.objects[object].name;
    return { links: visuals.children.map(({ userData }) => name(userData.object)), replaced: [...bodies.replaced].map(name),
      triangles: visuals.children.map(({ geometry }) => geometry.getIndex().count / 3), leftOut: visuals.leftOut,
      colours: visuals.children.map(({ userData: { colour } }) => colour && `#${colour.getHexString()}`) };
  });
  const modes = [await now()];
  for (const text of ["Both", "Bodies"]) {
    await page.click("#visuals");
    await page.waitForFunction((expected) => document.getElementById("visuals").textContent === expected, text);
    modes.push(await now());
  }
  return { ...shown, modes };
}

// Hides a group by its box in the list, and draws all again: the names of hidden objects, the address, the notice, and
// how many pairs the report has before and while.
async function hiding() {
  const now = () => page.evaluate(() => {
    const { state, view: { bodies } } = window.clearance;
    return { off: [...bodies.off].map((object) => bodies.cell.objects[object].name), address: new URLSearchParams(location.search).get("hide"),
      drawn: bodies.cell.objects.map(({ name }) => name).filter((name) => !bodies.bounds((each) => each.name === name).isEmpty()),
      notice: document.getElementById("hidden-count").hidden ? "" : document.getElementById("hidden-count").textContent, pairs: state.report.pairs.length };
  });
  const before = await now();
  await page.keyboard.press("o");
  await page.locator("#object-list summary", { hasText: "still" }).locator("input").click();
  const hidden = await now();
  await page.click("#all-objects");
  await page.keyboard.press("o");
  return { before, hidden, after: await now() };
}

// Measures two bodies that no rule pairs, and two whose pair is published, as two clicks on them do.
async function measuring() {
  const pick = (names) => page.evaluate((picked) => {
    const { scene } = window.clearance.state;
    for (const name of picked) window.clearance.view.on.objectChosen(scene.objects.findIndex((each) => each.name === name));
  }, names);
  const hint = () => page.$eval("#measure-hint", ({ textContent }) => textContent);
  const measured = () => page.evaluate(() => {
    const { state } = window.clearance, found = state.report.pairs.find(({ pair }) => pair === state.measuredId);
    return found && { ...found, lines: window.clearance.view.lines.shown.filter(({ pair }) => pair.pair === state.measuredId).length };
  });
  await page.click("#measure");
  await pick(["wall", "back"]);
  await page.waitForFunction(() => window.clearance.view.lines.shown.some(({ pair }) => pair.pair === window.clearance.state.measuredId));
  const free = { ...(await measured()), hint: await hint() };
  await pick(["swinging", "standing"]);
  const watched = { measured: await measured(), hint: await hint() };
  await page.keyboard.press("Escape");
  return { free, watched };
}

// The file that the button saves: its lines as fields, and the pairs of the report.
async function csv() {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#csv")]);
  const pieces = [];
  for await (const piece of await download.createReadStream()) pieces.push(piece);
  const lines = Buffer.concat(pieces).toString().split("\r\n").filter(Boolean).map((line) => line.split(","));
  return { name: download.suggestedFilename(), lines, pairs: await page.evaluate(() => window.clearance.state.report.pairs.length) };
}

// Plots of minutes, and the closing speed of a chosen pair: the width of the axis, and the speeds.
async function minutes() {
  await page.evaluate(() => window.clearance.view.on.pairChosen(window.clearance.state.pairs.find(({ name }) => name === "swinging – standing").id));
  await page.selectOption("#quantity", "speed");
  await page.selectOption("#span", "600");
  const speeds = () => page.waitForFunction(() => {
    const { data, scales } = window.clearance.plots.made.chosen?.plot ?? { data: [] };
    const known = (data[1] ?? []).filter((value) => value !== null);
    const isDrawnAnew = scales?.x.min !== -30; // half a minute, which was chosen before
    return isDrawnAnew && known.some((value) => value > 0.1) && known.some((value) => value < -0.1) && { width: scales.x.min, known: known.length };
  });
  return (await speeds()).jsonValue();
}

// The plot of how far cameras see links behind their places: the names of its curves, and the values, mm.
async function residuals() {
  const plotted = await page.waitForFunction(() => {
    const { data } = window.clearance.plots.made.residuals?.plot ?? { data: [] };
    const known = data.slice(1).flat().filter((value) => value !== null);
    return known.length > 0 && { known, names: [...document.querySelectorAll("#plot-residuals-names span")].map(({ textContent }) => textContent) };
  });
  return plotted.jsonValue();
}

// The page's texts for causes of zones by number, more than there are, as of the cell's first object.
const causes = () => page.evaluate(() => {
  const { state } = window.clearance;
  return { object: state.scene.objects[0].name, texts: [0, 1, 2, 3, 4, 5, 6, 7].map((cause) => state.causeOf({ cause, cause_object: 0 })) };
});

// What a camera sees: the bodies and points that are drawn, the pixels in their colour, the thickest shell, the row of the
// camera, and what is left in each mode.
async function seen() {
  await page.waitForFunction(() => {
    const { seen: { sensors, status } } = window.clearance.view;
    return sensors[0].ns > 0 && status[0]?.frames > 0 && Object.keys(status[0].shells).length > 0;
  });
  await page.waitForFunction(() => /^[0-9]/.test(document.querySelector("#sensors tbody tr")?.cells[1].textContent ?? ""));
  // The line to the nearest element of the pair that is chosen.
  await page.waitForFunction(() => {
    const { state, view } = window.clearance, [{ object }] = view.seen.cell.sensors, isOfCamera = ({ pair }) => state.pairs[pair] && [state.pairs[pair].a, state.pairs[pair].b].includes(object);
    const known = state.report?.pairs.find((pair) => pair.status < 5 && isOfCamera(pair));
    if (known && !view.lines.shown.some(({ pair }) => isOfCamera(pair))) view.on.pairChosen(known.pair);
    return view.lines.shown.some(({ pair }) => isOfCamera(pair));
  });
  // The hand and the line are not in every frame.
  const found = await page.waitForFunction(() => {
    const { view, state } = window.clearance, { seen: shown, renderer } = view, [{ points }] = shown.sensors, [{ object: camera }] = shown.cell.sensors;
    const shells = Object.fromEntries(Object.entries(shown.status[0].shells).map(([object, thickness]) => [shown.cell.objects[object].name, thickness]));
    const lines = view.lines.shown.filter(({ pair }) => [state.pairs[pair.pair].a, state.pairs[pair.pair].b].includes(camera)).length;
    if (!shells.hand || lines === 0) return null;
    const pixels = () => {
      view.redraw();
      const gl = renderer.getContext(), { drawingBufferWidth: width, drawingBufferHeight: height } = gl, all = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
      // A chosen pair's points have another colour.
      const [red, green, blue] = points.material.uniforms.colour.value.toArray().map((share) => 255 * share);
      let count = 0;
      for (let i = 0; i < all.length; i += 4) count += Math.abs(all[i] - red) + Math.abs(all[i + 1] - green) + Math.abs(all[i + 2] - blue) < 12;
      return count;
    };
    const drawn = pixels();
    points.visible = false;
    const without = pixels();
    points.visible = true;
    return {
      lines,
      places: [...points.geometry.getAttribute("position").array], drawn, without,
      bodies: shown.cell.parts.filter(({ object }) => shown.cell.sensors.some((sensor) => sensor.object === object)).length,
      shells,
      pose: shown.status[0].pose, row: [...document.querySelector("#sensors tbody tr").cells].map(({ textContent }) => textContent),
    };
  });
  const modes = [];
  for (let i = 0; i < 3; ++i) {
    await page.keyboard.press("p");
    await frames(3);
    modes.push(await page.evaluate(() => ({ all: window.clearance.view.seen.visible, shells: window.clearance.view.seen.shells.visible })));
  }
  return { ...(await found.jsonValue()), modes };
}

const known = { crowded, robots, seen, causes, inputs, visuals, hiding, measuring, csv, minutes, residuals, resolution, firstView, look, labels, fading, layout, keys, ticks, zones };
try {
  await page.goto(url);
  await ready();
  for (const step of steps) say({ step, found: await known[step]() });
  say({ step: "errors", found: errors });
} catch (error) {
  say({ failed: error.stack, errors });
  process.exitCode = 1;
}
await browser.close();
