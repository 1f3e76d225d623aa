// Foxglove's own client: subscribes to every channel and decodes the messages by their schemas, of a daemon until it has
// REPORTS reports and a message of each topic, or until a status has TEXT, where it prints "follows" once it has 60
// reports; of a recording, it sets the time and waits until that stands there:
//   node foxglove.mjs URL reports REPORTS TOPICS...
//   node foxglove.mjs URL status TEXT
//   node foxglove.mjs URL time TIME
import { parseIDL } from "@foxglove/omgidl-parser";
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

import { markersOf, plain, readerOf } from "./decode.mjs";

const { FoxgloveClient } = protocol;
const [url, what, figure, ...topics] = process.argv.slice(2);
const STANDS = 20; // frames without a message
const FOLLOWS = 60; // reports
const client = new FoxgloveClient({ ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const found = { channels: {}, first: {}, last: {}, cycles: [], times: [], statuses: [], redefined: [] };
const definitions = new Map(); // of all channels, by name
const channels = new Map();

client.on("serverInfo", ({ name, capabilities }) => Object.assign(found, { name, capabilities }));
client.on("error", (error) => { throw error; });
client.on("status", ({ level, message }) => {
  found.statuses.push({ level, message });
  sayIfTold();
});
let quiet = 0;
client.on("time", () => {
  quiet += 1;
  if (what === "time" && found.parameters && found.last["clearance/distances"] && quiet > STANDS) say();
});
client.on("advertise", (advertised) => {
  for (const { id, topic, encoding, schemaName, schema, schemaEncoding } of advertised) {
    found.channels[topic] = { encoding, schemaName, schemaEncoding };
    if (schemaEncoding === "omgidl") define(schema);
    channels.set(client.subscribe(id), { topic, reader: readerOf(schemaName, schemaEncoding, schema) });
  }
  if (what === "time") client.setParameters([{ name: "playback.time", value: Number(figure) }], "set");
});
client.on("parameterValues", ({ parameters, id }) => {
  if (id !== "set") return;
  found.parameters = Object.fromEntries(parameters.map(({ name, value }) => [name, value]));
  quiet = 0;
});
client.on("message", ({ subscriptionId, data }) => {
  const { topic, reader } = channels.get(subscriptionId);
  const message = reader.readMessage(data);
  quiet = 0;
  if (topic.endsWith("distances")) {
    found.cycles.push(message.cycle);
    found.times.push(message.now_ns);
    if (what === "status" && found.cycles.length === FOLLOWS) console.log('"follows"');
  }
  sayIfTold();
  found.last[topic] = message.markers ? markersOf(message) : message;
  found.first[topic] ??= found.last[topic];
  if (what === "reports" && found.cycles.length >= Number(figure) && topics.every((each) => found.last[each])) say();
});

// A viewer holds one definition of each name, and shows an error when a channel brings another one.
function define(schema) {
  for (const { name, ...definition } of parseIDL(schema)) {
    const text = JSON.stringify(definition, plain);
    if ((definitions.get(name) ?? text) !== text) found.redefined.push(name);
    definitions.set(name, text);
  }
}

function sayIfTold() {
  if (what !== "status" || found.cycles.length < FOLLOWS) return;
  if (found.statuses.some(({ message }) => message.includes(figure))) say();
}

function say() {
  console.log(JSON.stringify(found, plain));
  process.exit(0);
}
