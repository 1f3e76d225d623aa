// How fast the page draws a cell, what a frame costs, and how many frames there are of the same page with an empty scene: the
// daemon, a simulated robot and clearance-view run, and Debian's Chromium, which draws in software, shows the page:
//   node frames.mjs BIN CELL SECONDS [WIDTH HEIGHT]
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readdirSync, readFileSync } from "node:fs";
import { chromium } from "playwright-core";

const [bin, cell, seconds, width = "1440", height = "900"] = process.argv.slice(2);
const SETTLE_MS = 6000; // until the page has found how many pixels it can draw
const children = ["clearanced", "clearance-robot", "clearance-view"].map((name) =>
  spawn(`${bin}/${name}`, [cell, "--partition", `frames-${process.pid}`, ...(name === "clearance-view" ? ["--port", "0"] : [])], { stdio: ["ignore", "pipe", "ignore"] }));
const address = String((await once(children[2].stdout, "data"))[0]).trim();

const browser = await chromium.launch({
  executablePath: "/usr/bin/chromium",
  // WebGL in software, and the page itself drawn as Chromium does without a graphics card.
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas"],
});
const page = await browser.newPage({ viewport: { width: Number(width), height: Number(height) } });
await page.goto(address);
await page.waitForFunction(() => window.clearance?.shownFor() > 0, undefined, { timeout: 100_000 });
await page.waitForTimeout(SETTLE_MS);

// Processor time of all of the browser's processes, whatever else the machine does: s.
function browserTime() {
  const stats = readdirSync("/proc").filter(Number).flatMap((pid) => {
    try {
      const [name, rest] = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ");
      return [{ pid: Number(pid), name, fields: rest.split(" ") }];
    } catch {
      return []; // it has just ended
    }
  });
  const isOurs = (pid) => pid === process.pid || stats.some((each) => each.pid === pid && pid > 1 && isOurs(Number(each.fields[1])));
  return stats.filter(({ pid, name }) => /chrom/.test(name) && isOurs(pid)).reduce((sum, { fields }) => sum + (Number(fields[11]) + Number(fields[12])) / 100, 0);
}

const devtools = await page.context().newCDPSession(page);
await devtools.send("Performance.enable", { timeDomain: "threadTicks" });
// Counts so far; times in s of the processor that the page's main thread had.
const counts = async () => ({
  ...Object.fromEntries((await devtools.send("Performance.getMetrics")).metrics.map(({ name, value }) => [name, value])),
  ...(await page.evaluate(() => ({ frames: window.clearance.stands().frames, drawn: window.clearance.view.drawn, ms: performance.now() }))),
  Browser: browserTime(),
});
async function measure() {
  const before = await counts();
  await page.waitForTimeout(1000 * seconds);
  const after = await counts();
  const passed = (name) => after[name] - before[name];
  return { each: (name) => Number(((1000 * passed(name)) / passed("drawn")).toFixed(2)), rate: Number(((1000 * passed("drawn")) / passed("ms")).toFixed(1)) };
}
const { each, rate } = await measure();
const cost = each("Browser");
const found = {
  ...(await page.evaluate(() => ({
    objects: window.clearance.state.scene.objects.length, parts: window.clearance.view.bodies.parts.length,
    pairs: window.clearance.state.report.pairs.length, pixels: [document.getElementById("view").width, document.getElementById("view").height],
    drawCalls: window.clearance.view.renderer.info.render.calls, triangles: window.clearance.view.renderer.info.render.triangles,
  }))),
  framesPerSecond: rate, browserMsPerFrame: cost,
  scriptMsPerFrame: each("ScriptDuration"), styleAndLayoutMsPerFrame: Number((each("LayoutDuration") + each("RecalcStyleDuration")).toFixed(2)),
  mainThreadMsPerFrame: each("TaskDuration"),
};
await page.evaluate(() => window.clearance.view.world.children.forEach((child) => (child.visible = false)));
await page.evaluate(() => (window.clearance.view.backdrop.update = () => {}));
const empty = await measure();
console.log(JSON.stringify({ ...found, emptyScene: { framesPerSecond: empty.rate, browserMsPerFrame: empty.each("Browser") } }, null, 1));
await browser.close();
for (const child of children) child.kill("SIGTERM");
