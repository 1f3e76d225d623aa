// The scene of a recording, as the official reader and the public ROS 2 packages see it: node scene.mjs FILE
import { open } from "node:fs/promises";

import { McapIndexedReader } from "@mcap/core";

import { markersOf, plain, readerOf } from "./decode.mjs";

const handle = await open(process.argv[2]);
const readable = {
  size: async () => BigInt((await handle.stat()).size),
  read: async (offset, length) => (await handle.read(new Uint8Array(Number(length)), 0, Number(length), Number(offset))).buffer,
};
const mcap = await McapIndexedReader.Initialize({ readable });
const found = {}, readers = new Map();
for await (const { channelId, data } of mcap.readMessages({ validateCrcs: true })) {
  const { topic, schemaId } = mcap.channelsById.get(channelId);
  const { name, encoding, data: schema } = mcap.schemasById.get(schemaId);
  if (!readers.has(channelId)) readers.set(channelId, readerOf(name, encoding, new TextDecoder().decode(schema)));
  const message = readers.get(channelId).readMessage(data);
  const entry = (found[topic] ??= { schema: name, encoding, messages: 0 });
  entry.messages += 1;
  entry.last = message.markers ? markersOf(message) : message;
}
console.log(JSON.stringify(found, plain));
await handle.close();
