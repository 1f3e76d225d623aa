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

// tf2_msgs/msg/TFMessage: [child frame, [x, y, z, qx, qy, qz, qw]] of each transform.
export function transforms(bytes) {
  return decodeTransforms(bytes).transforms.map(({ child_frame_id, transform: { translation: t, rotation: q } }) =>
    [child_frame_id, [t.x, t.y, t.z, q.x, q.y, q.z, q.w]]);
}
