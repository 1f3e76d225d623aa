// Asks clearance-view as a browser would for pages of other servers, and says the status of each answer. Each case is a
// JSON object {host, origin}; a missing one is what the own page has, and null leaves the header out:
//   node access.mjs URL CASE...
import http from "node:http";

const [url, ...cases] = process.argv.slice(2);
const { hostname, port, host: own } = new URL(url);

function ask(path, headers) {
  return new Promise((done, fail) => {
    const request = http.request({ hostname, port, path, headers, setHost: false });
    request.on("response", (answer) => {
      let text = "";
      answer.on("data", (bytes) => (text += bytes)).on("end", () => done({ status: answer.statusCode, text: text.slice(0, 400) }));
    });
    request.on("upgrade", (answer, socket) => (socket.destroy(), done({ status: answer.statusCode })));
    request.on("error", fail);
    request.end();
  });
}

for (const text of cases) {
  const asked = JSON.parse(text);
  const headers = {};
  if (asked.host !== null) headers.Host = (asked.host ?? own).replace("PORT", port);
  if (asked.origin !== null) headers.Origin = (asked.origin ?? `http://${own}`).replace("PORT", port);
  const page = await ask("/", headers), scene = await ask("/scene.json", headers);
  const socket = await ask("/", { ...headers, Connection: "Upgrade", Upgrade: "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==" });
  console.log(JSON.stringify({ ...asked, page: page.status, scene: scene.status, socket: socket.status, text: page.status === 200 ? "" : page.text }));
}
