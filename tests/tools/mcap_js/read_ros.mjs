// Decodes messages of ROS 2 by the definitions that ROS 2 publishes, with the public packages: node read_ros.mjs,
// on stdin a line a message, "TYPE BASE64"; on stdout their values, a JSON line each. With a folder of .msg files as
// argument, it knows those of the package clearance_msgs, too.
import { readdirSync, readFileSync } from "node:fs";

import { parse } from "@foxglove/rosmsg";
import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const known = { ...ros2humble };
const folder = process.argv[2];
for (const file of folder ? readdirSync(folder) : []) {
  const name = `clearance_msgs/${file.replace(/\.msg$/, "")}`;
  known[name] = { ...parse(readFileSync(`${folder}/${file}`, "utf8"), { ros2: true, skipTypeFixup: true })[0], name };
}

const readers = new Map();
function readerOf(type) {
  if (!readers.has(type)) {
    const others = Object.values(known).filter(({ name }) => name !== type);
    readers.set(type, new MessageReader([known[type], ...others]));
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
