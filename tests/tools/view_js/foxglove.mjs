// Foxglove's own client: subscribes to every channel, decodes a message of each by its schema, counts the reports of two
// seconds, and sets a parameter: node foxglove.mjs URL [TIME]
import protocol from "@foxglove/ws-protocol";
import WebSocket from "ws";

import { markersOf, plain, readerOf } from "./decode.mjs";

const { FoxgloveClient } = protocol;
const [url, time] = process.argv.slice(2);
const client = new FoxgloveClient({ ws: new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
const found = { channels: {}, first: {}, last: {}, reports: 0, times: 0, statuses: [] };
const channels = new Map();

client.on("serverInfo", ({ name, capabilities }) => Object.assign(found, { name, capabilities }));
client.on("error", (error) => { throw error; });
client.on("status", ({ level, message }) => found.statuses.push({ level, message }));
client.on("time", () => (found.times += 1));
client.on("advertise", (advertised) => {
  for (const { id, topic, encoding, schemaName, schema, schemaEncoding } of advertised) {
    found.channels[topic] = { encoding, schemaName, schemaEncoding };
    channels.set(client.subscribe(id), { topic, reader: readerOf(schemaName, schemaEncoding, schema) });
  }
  if (time !== undefined) client.setParameters([{ name: "playback.time", value: Number(time) }], "set");
});
client.on("parameterValues", ({ parameters, id }) => {
  if (id === "set") found.parameters = Object.fromEntries(parameters.map(({ name, value }) => [name, value]));
});
client.on("message", ({ subscriptionId, data }) => {
  const { topic, reader } = channels.get(subscriptionId);
  const message = reader.readMessage(data);
  if (topic.endsWith("distances")) found.reports += 1;
  found.last[topic] = message.markers ? markersOf(message) : message;
  found.first[topic] ??= found.last[topic];
});

setTimeout(() => {
  console.log(JSON.stringify(found, plain));
  process.exit(0);
}, 2000);
