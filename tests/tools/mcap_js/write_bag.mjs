// Writes a bag as rosbag2 does, with the official MCAP writer and the public packages for ROS 2's messages:
// node write_bag.mjs OUT.mcap < SPEC. SPEC: {"compression": "" | "zstd" | "lz4", "messages": [{"topic", "type",
// "log_ns": "...", "value": {...}}, ...]}. Without OUT.mcap, each message's CDR goes to stdout in base64, a line each.
import { open } from "node:fs/promises";
import { readFileSync } from "node:fs";

import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { isLoaded, compress as compressZstd } from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import lz4 from "lz4js";

const header = "std_msgs/Header header\n";
const between = "=".repeat(80) + "\n";
const headerText = between + "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
  between + "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const transformText = between + "MSG: geometry_msgs/TransformStamped\n" + header +
  "string child_frame_id\nTransform transform\n" +
  between + "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n" +
  between + "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n" +
  between + "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n" + headerText;

const schemas = {
  "sensor_msgs/msg/JointState":
    header + "string[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n" + headerText,
  "tf2_msgs/msg/TFMessage": "geometry_msgs/TransformStamped[] transforms\n" + transformText,
  "std_msgs/msg/String": "string data\n",
};

const spec = JSON.parse(readFileSync(0, "utf8"));
const writers = Object.fromEntries(
  Object.entries(schemas).map(([type, text]) => [type, new MessageWriter(parse(text, { ros2: true }))]));
const cdr = (message) => writers[message.type].writeMessage(message.value);

async function writeMcap(file) {
  await isLoaded;
  const handle = await open(file, "w");
  let position = 0;
  const writable = {
    position: () => BigInt(position),
    write: async (bytes) => {
      await handle.write(bytes);
      position += bytes.length;
    },
  };
  const compress = { zstd: (bytes) => compressZstd(bytes, 3), lz4: (bytes) => lz4.compress(bytes) };
  const method = spec.compression;
  const writer = new McapWriter({
    writable,
    chunkSize: 4096,
    compressChunk: method ? (bytes) => ({ compression: method, compressedData: compress[method](bytes) }) : undefined,
  });
  await writer.start({ profile: "ros2", library: "clearance tests" });
  const channels = new Map();
  for (const message of spec.messages) {
    if (!channels.has(message.topic)) {
      const schemaId = await writer.registerSchema({
        name: message.type, encoding: "ros2msg", data: new TextEncoder().encode(schemas[message.type]) });
      channels.set(message.topic, await writer.registerChannel({
        schemaId, topic: message.topic, messageEncoding: "cdr", metadata: new Map() }));
    }
    const time = BigInt(message.log_ns);
    await writer.addMessage({
      channelId: channels.get(message.topic), sequence: 0, logTime: time, publishTime: time, data: cdr(message) });
  }
  await writer.end();
  await handle.close();
}

if (process.argv[2]) {
  await writeMcap(process.argv[2]);
} else {
  for (const message of spec.messages) console.log(Buffer.from(cdr(message)).toString("base64"));
}
