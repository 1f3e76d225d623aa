// Decodes messages of ROS 2 by the definitions that ROS 2 publishes, with the public packages: node read_ros.mjs,
// on stdin a line a message, "TYPE BASE64"; on stdout their values, a JSON line each.
import { readFileSync } from "node:fs";

import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const readers = new Map();
function readerOf(type) {
  if (!readers.has(type)) {
    const others = Object.values(ros2humble).filter(({ name }) => name !== type);
    readers.set(type, new MessageReader([ros2humble[type], ...others]));
  }
  return readers.get(type);
}

function plain(key, value) {
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}

for (const line of readFileSync(0, "utf8").split("\n").filter((text) => text !== "")) {
  const [type, cdr] = line.split(" ");
  console.log(JSON.stringify(readerOf(type).readMessage(Buffer.from(cdr, "base64")), plain));
}
