// Decodes messages in CDR with Foxglove's omgidl packages, by the IDL that the server sends.
import { MessageReader, parseIDL } from "omgidl";

// decoder("... IDL ...", "clearance::msg::Distances")(dataView) is the message.
export function decoder(idl, type) {
  const reader = new MessageReader(type, parseIDL(idl));
  return (bytes) => reader.readMessage(bytes);
}

const TRANSFORMS = `
  struct Time { int32 sec; uint32 nanosec; };
  struct Header { Time stamp; string frame_id; };
  struct Vector3 { double x; double y; double z; };
  struct Quaternion { double x; double y; double z; double w; };
  struct Transform { Vector3 translation; Quaternion rotation; };
  struct TransformStamped { Header header; string child_frame_id; Transform transform; };
  struct TFMessage { sequence<TransformStamped> transforms; };`;
const decodeTransforms = decoder(TRANSFORMS, "TFMessage");

const POINTS = `
  struct Time { int32 sec; uint32 nanosec; };
  struct Header { Time stamp; string frame_id; };
  struct PointField { string name; uint32 offset; uint8 datatype; uint32 count; };
  struct PointCloud2 { Header header; uint32 height; uint32 width; sequence<PointField> fields; boolean is_bigendian;
    uint32 point_step; uint32 row_step; sequence<uint8> data; boolean is_dense; };`;
const decodePoints = decoder(POINTS, "PointCloud2");

// sensor_msgs/msg/PointCloud2 of /clearance/seen: the number of the sensor, undefined without points, and their places.
export function seenPoints(bytes) {
  const { data, width, point_step: step } = decodePoints(bytes), view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const positions = new Float32Array(3 * width);
  for (let i = 0; i < positions.length; ++i) positions[i] = view.getFloat32(step * Math.floor(i / 3) + 4 * (i % 3), true);
  return { sensor: width ? view.getUint32(12, true) : undefined, positions };
}

// tf2_msgs/msg/TFMessage: [child frame, [x, y, z, qx, qy, qz, qw]] of each transform.
export function transforms(bytes) {
  return decodeTransforms(bytes).transforms.map(({ child_frame_id, transform: { translation: t, rotation: q } }) =>
    [child_frame_id, [t.x, t.y, t.z, q.x, q.y, q.z, q.w]]);
}
