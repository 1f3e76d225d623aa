// Messages by the schema that came with them, with the public packages: nothing here is ours.
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader as IdlReader } from "@foxglove/omgidl-serialization";
import { parse as parseRos } from "@foxglove/rosmsg";
import { MessageReader as RosReader } from "@foxglove/rosmsg2-serialization";

export function readerOf(name, encoding, schema) {
  if (encoding === "omgidl") return new IdlReader(name, parseIDL(schema));
  if (encoding === "ros2msg") return new RosReader(parseRos(schema, { ros2: true }));
  throw new Error(`schema encoding ${encoding}`);
}

// What a test asks of a MarkerArray.
export function markersOf({ markers }) {
  return markers.map(({ header, ns, type, action, text, points, pose, color }) => ({
    frame: header.frame_id, ns, type, action, text, points: points.length, position: pose.position, opacity: color.a,
  }));
}

export function plain(key, value) {
  if (typeof value === "bigint") return Number(value);
  if (typeof value === "number" && !Number.isFinite(value)) return String(value);
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}
