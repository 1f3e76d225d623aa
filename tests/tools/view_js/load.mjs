// What viewers cost: the daemon, a simulated robot and clearance-view run with each number of viewers, which subscribe to
// what the page does; a row each of processor time and, of the same seconds, the daemon's tick and latency:
//   node load.mjs BIN CELL SECONDS VIEWERS...
import { spawn } from "node:child_process";
import { once } from "node:events";
import { readFileSync } from "node:fs";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

const [bin, cell, seconds, ...counts] = process.argv.slice(2);
const TICKS_PER_S = 100; // USER_HZ, of /proc
const SETTLE_MS = 2000;
const wait = (ms) => new Promise((done) => setTimeout(done, ms));

function start(name, ...more) {
  const child = spawn(`${bin}/${name}`, [cell, "--partition", `load-${process.pid}`, ...more], { stdio: ["ignore", "pipe", "pipe"] });
  child.text = "";
  for (const stream of [child.stdout, child.stderr]) stream.on("data", (bytes) => (child.text += bytes));
  return child;
}
async function end(child) {
  if (child.exitCode === null) {
    child.kill("SIGTERM");
    await once(child, "exit");
  }
}
async function says(child, pattern) {
  while (!pattern.test(child.text)) {
    if (child.exitCode !== null) throw new Error(child.text);
    await wait(20);
  }
  return pattern.exec(child.text);
}

// User and system time of a process with all its threads, s.
function processorTime({ pid }) {
  const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ").at(-1).split(" ");
  return (Number(fields[11]) + Number(fields[12])) / TICKS_PER_S;
}

// Counts the reports that come.
function viewer(address) {
  const client = new protocol.FoxgloveClient({ ws: new WebSocket(address.replace("http", "ws"), ["foxglove.websocket.v1"]) });
  const seen = { client, reports: 0 };
  const ids = new Map();
  client.on("advertise", (channels) => {
    for (const { id, topic } of channels) if (/\/(distances|zones|health|separation)$|^\/tf$/.test(topic)) ids.set(client.subscribe(id), topic);
  });
  client.on("message", ({ subscriptionId }) => (seen.reports += /distances$/.test(ids.get(subscriptionId)) ? 1 : 0));
  return seen;
}

async function measure(count) {
  const daemon = start("clearanced"), view = start("clearance-view", "--port", "0");
  // A rate that is not the daemon's own: every phase between the two is met.
  const robot = start("clearance-robot", "--rate", "997", "--latency");
  const [address] = await says(view, /http:\S+/);
  const viewers = Array.from({ length: count }, () => viewer(address));
  await wait(SETTLE_MS);
  const before = [view, daemon].map(processorTime), reports = viewers.map((each) => each.reports);
  await wait(1000 * seconds);
  const share = [view, daemon].map((each, i) => ((processorTime(each) - before[i]) / seconds).toFixed(3));
  const rate = count ? (viewers.reduce((sum, each, i) => sum + each.reports - reports[i], 0) / count / seconds).toFixed(1) : "";
  for (const { client } of viewers) client.close();
  for (const child of [robot, view, daemon]) await end(child);
  const percentiles = (child, line) => new RegExp(`${line} +p50 ([\\d.]+) us +p99.9 ([\\d.]+) us`).exec(child.text)?.slice(1).join(" / ");
  console.log(`| ${[count, rate, ...share, percentiles(daemon, "tick"), percentiles(robot, "latency")].join(" | ")} |`);
}

console.log("| viewers | reports a second to each | clearance-view, cores | clearanced, cores | tick, p50 / p99.9 us | latency, p50 / p99.9 us |");
console.log("|---|---|---|---|---|---|");
for (const count of counts.map(Number)) await measure(count);
