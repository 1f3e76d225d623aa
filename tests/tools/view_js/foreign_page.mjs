// Opens pages of other servers in Debian's Chromium, which ask clearance-view: a page of another port, a page of a foreign
// name that was rebound to this machine, and the own page.
//   node foreign_page.mjs PORT
import http from "node:http";
import { once } from "node:events";

import { openBrowser, say } from "./browser.mjs";

const [port] = process.argv.slice(2);
const foreign = http.createServer((_, answer) => answer.setHeader("Content-Type", "text/html").end("<p>A page of another server</p>"));
foreign.listen(0, "127.0.0.1");
await once(foreign, "listening");
const { browser, page } = await openBrowser();

// What this page gets from an address: whether its WebSocket opens, and whether the cell can be read.
async function gets(from, address) {
  await page.goto(from, { waitUntil: "commit" });
  return page.evaluate(async (host) => {
    const opens = await new Promise((done) => {
      const socket = new WebSocket(`ws://${host}/`, ["foxglove.websocket.v1"]);
      socket.onmessage = () => done(true);
      socket.onerror = () => done(false);
    });
    const reads = await fetch(`http://${host}/scene.json`).then(({ ok }) => ok, () => false);
    return { opens, reads };
  }, address);
}

const other = `127.0.0.1:${foreign.address().port}`;
say({
  own: await gets(`http://127.0.0.1:${port}/`, `127.0.0.1:${port}`),
  localhost: await gets(`http://localhost:${port}/`, `localhost:${port}`),
  otherPort: await gets(`http://${other}/`, `127.0.0.1:${port}`),
  rebound: await gets(`http://rebound.example:${port}/`, `rebound.example:${port}`),
});
await browser.close();
foreign.close();
