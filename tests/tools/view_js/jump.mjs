// Jumps in a recording, through Foxglove's own client: node jump.mjs URL TIME... prints of each time what the zones said
// last and what was before, a line of JSON a time.
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

import { plain, readerOf } from "./decode.mjs";

const { FoxgloveClient } = protocol;
const [url, ...times] = process.argv.slice(2);
const client = new FoxgloveClient({ ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const readers = new Map(), last = {};
const STANDS = 20; // frames without a message
let quiet = 0, stands;
client.on("time", () => {
  quiet += 1;
  if (quiet > STANDS) stands?.();
});
client.on("parameterValues", ({ id }) => (quiet = id === "set" ? 0 : quiet));

client.on("error", (error) => { throw error; });
client.on("message", ({ subscriptionId, data }) => {
  const { topic, reader } = readers.get(subscriptionId);
  last[topic] = reader.readMessage(data);
  quiet = 0;
});
await new Promise((done) => client.on("advertise", (channels) => {
  for (const { id, topic, schemaName, schema, schemaEncoding } of channels) {
    if (!/zones|distances/.test(topic)) continue;
    readers.set(client.subscribe(id), { topic, reader: readerOf(schemaName, schemaEncoding, schema) });
  }
  done();
}));

for (const time of times.map(Number)) {
  quiet = -Infinity; // until it is set
  const there = new Promise((done) => (stands = done));
  client.setParameters([{ name: "playback.time", value: time }], "set");
  await there;
  const history = await (await fetch(new URL(`/history.json?end=${time}&pairs=2`, url.replace("ws", "http")))).json();
  console.log(JSON.stringify({ time, zone: last["clearance/zones"], cycle: last["clearance/distances"].cycle, history }, plain));
}
process.exit(0);
