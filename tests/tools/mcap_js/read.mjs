// Reads an MCAP file twice, streamed and indexed, decodes every message by the schema that the file holds,
// and prints what it found as JSON: node read.mjs FILE
import { open, readFile } from "node:fs/promises";

import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { isLoaded, decompress as decompressZstd } from "@foxglove/wasm-zstd";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

await isLoaded;
const decompressHandlers = { zstd: (bytes, size) => decompressZstd(bytes, Number(size)) };

class Decoder {
  #readers = new Map();

  decode(schema, data) {
    if (schema.encoding !== "omgidl") throw new Error(`schema encoding ${schema.encoding}`);
    if (!this.#readers.has(schema.id)) {
      const definitions = parseIDL(new TextDecoder().decode(schema.data));
      this.#readers.set(schema.id, new MessageReader(schema.name, definitions));
    }
    return this.#readers.get(schema.id).readMessage(data);
  }
}

// What is kept of a reading: counts, times and the first and last message of each topic.
class Reading {
  #decoder = new Decoder();
  topics = {};
  order = [];

  add(channel, schema, message) {
    if (channel.messageEncoding !== "cdr") throw new Error(`message encoding ${channel.messageEncoding}`);
    const topic = (this.topics[channel.topic] ??= { type: schema.name, messages: 0 });
    const value = this.#decoder.decode(schema, message.data);
    topic.messages += 1;
    topic.first ??= value;
    topic.last = value;
    this.order.push(`${channel.topic} ${message.sequence} ${message.logTime}`);
  }
}

async function readStreamed(file) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  const reading = new Reading();
  const channels = new Map();
  const schemas = new Map();
  const bytes = await readFile(file);
  for (let at = 0; at < bytes.length; at += 1000) {
    reader.append(bytes.subarray(at, at + 1000));
    for (let record; (record = reader.nextRecord()); ) {
      if (record.type === "Schema") schemas.set(record.id, record);
      if (record.type === "Channel") channels.set(record.id, record);
      if (record.type !== "Message") continue;
      const channel = channels.get(record.channelId);
      reading.add(channel, schemas.get(channel.schemaId), record);
    }
  }
  if (!reader.done()) throw new Error("the stream ends too early");
  return reading;
}

async function readIndexed(file, window) {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, length) => {
      const buffer = new Uint8Array(Number(length));
      const { bytesRead } = await handle.read(buffer, 0, buffer.length, Number(offset));
      if (bytesRead !== buffer.length) throw new Error("read beyond the end");
      return buffer;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const reading = new Reading();
  for await (const message of reader.readMessages({ validateCrcs: true, ...window })) {
    const channel = reader.channelsById.get(message.channelId);
    reading.add(channel, reader.schemasById.get(channel.schemaId), message);
  }
  reading.metadata = {};
  for await (const metadata of reader.readMetadata()) {
    reading.metadata[metadata.name] = Object.fromEntries(metadata.metadata);
  }
  reading.statistics = reader.statistics;
  reading.compressions = [...new Set(reader.chunkIndexes.map((chunk) => chunk.compression))];
  await handle.close();
  return reading;
}

function plain(key, value) {
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  if (value instanceof Map) return Object.fromEntries(value);
  return value;
}

const file = process.argv[2];
const streamed = await readStreamed(file);
const indexed = await readIndexed(file);
const start = indexed.statistics.messageStartTime;
const middle = (start + indexed.statistics.messageEndTime) / 2n;
const window = await readIndexed(file, { startTime: middle });
console.log(JSON.stringify({ streamed, indexed, second_half: window.order.length, middle }, plain));
