#include "monitor/sensors/built_frames.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <utility>

#include "monitor/inputs/checksum.hpp"

namespace clearance {
namespace {

clearance_msg_PastBody to_wire(const PastPose& past) {
  const Pose& pose = past.world_from_body;
  const Eigen::Quaterniond& turn = pose.orientation;
  return {.known = past.known,
          .position = {pose.position.x(), pose.position.y(), pose.position.z()},
          .orientation = {turn.x(), turn.y(), turn.z(), turn.w()},
          .shift_error = past.shift_error,
          .turn_error = past.turn_error};
}

// Bit for bit: nothing is normalised.
PastPose from_wire(const clearance_msg_PastBody& past) {
  PastPose pose{.known = past.known,
                .world_from_body = {},
                .shift_error = past.shift_error,
                .turn_error = past.turn_error};
  pose.world_from_body.position = {past.position[0], past.position[1], past.position[2]};
  pose.world_from_body.orientation.coeffs() << past.orientation[0], past.orientation[1],
      past.orientation[2], past.orientation[3];
  return pose;
}

void add(const PastPose& past, Checksum& sum) {
  sum.add(past.known);
  sum.add_pose(past.world_from_body);
  sum.add(past.shift_error);
  sum.add(past.turn_error);
}

// A checksum of all that it is built of, but for the frames before.
std::uint64_t of_itself(const BuiltFrame& frame) {
  Checksum sum;
  sum.add(frame.scene_revision);
  sum.add(frame.sensor);
  sum.add(frame.stamp_ns);
  add(frame.place, sum);
  sum.add(frame.carrier.kind);
  sum.add(frame.carrier.object);
  sum.add(frame.carrier.robot);
  sum.add(frame.carrier.link);
  for (const PlacedPostures::Joint& joint : frame.postures.joints) {
    sum.add(joint.known);
    sum.add(joint.position);
    sum.add(joint.may_have_moved);
  }
  for (const PastPose& object : frame.postures.objects) add(object, sum);
  const PinholeCamera& camera = frame.camera;
  sum.add(camera.width);
  sum.add(camera.height);
  for (const double value : {camera.fx, camera.fy, camera.cx, camera.cy}) sum.add(value);
  sum.add(frame.message.type);
  sum.add_bytes(frame.message.cdr);
  return sum.value();
}

}  // namespace

FrameNames::FrameNames(const Scene& scene) {
  for (const Sensor& sensor : scene.sensors)
    former_.emplace_back(std::max<std::uint32_t>(sensor.persist_of, 1) - 1);
}

std::uint64_t FrameNames::name(const BuiltFrame& frame) {
  std::deque<std::uint64_t>& former = former_[frame.sensor];
  former.push_front(of_itself(frame));
  Checksum sum;
  for (const std::uint64_t each : former) sum.add(each);
  former.pop_back();
  return sum.value();
}

void BuiltFrames::put(BuiltFrame frame) {
  const Lock lock(mutex_);
  bytes_ += frame.message.cdr.size();
  frames_.push_back(std::move(frame));
  for (; bytes_ > kMostBytes; frames_.pop_front()) bytes_ -= frames_.front().message.cdr.size();
}

std::vector<BuiltFrame> BuiltFrames::take(std::uint32_t sensor, std::int64_t stamp_ns) {
  const Lock lock(mutex_);
  std::vector<BuiltFrame> taken;
  std::erase_if(frames_, [&](BuiltFrame& frame) REQUIRES(mutex_) {
    if (frame.sensor != sensor || frame.stamp_ns > stamp_ns) return false;
    bytes_ -= frame.message.cdr.size();
    taken.push_back(std::move(frame));
    return true;
  });
  return taken;
}

Sample<clearance_msg_SensorFrame> to_wire(const BuiltFrame& frame, std::uint64_t cycle,
                                          bool with_message) {
  Sample<clearance_msg_SensorFrame> out;
  out->cycle = cycle;
  out->scene_revision = frame.scene_revision;
  out->sensor = frame.sensor;
  out->stamp_ns = frame.stamp_ns;
  out->place = to_wire(frame.place);
  reserve_sequence(out->joints, frame.postures.joints.size());
  for (const PlacedPostures::Joint& joint : frame.postures.joints)
    out->joints._buffer[out->joints._length++] = {joint.known, joint.position,
                                                  joint.may_have_moved};
  reserve_sequence(out->objects, frame.postures.objects.size());
  for (const PastPose& object : frame.postures.objects)
    out->objects._buffer[out->objects._length++] = to_wire(object);
  const PinholeCamera& camera = frame.camera;
  out->width = camera.width;
  out->height = camera.height;
  out->fx = camera.fx;
  out->fy = camera.fy;
  out->cx = camera.cx;
  out->cy = camera.cy;
  out->kind = static_cast<std::uint8_t>(frame.message.type);
  out->carrier = {static_cast<std::uint8_t>(frame.carrier.kind), frame.carrier.object,
                  frame.carrier.robot, frame.carrier.link};
  if (!with_message) return out;
  const std::span<const std::byte> bytes = frame.message.cdr;
  reserve_sequence(out->message, bytes.size());
  std::memcpy(out->message._buffer, bytes.data(), bytes.size());
  out->message._length = static_cast<std::uint32_t>(bytes.size());
  return out;
}

BuiltFrame from_wire(const clearance_msg_SensorFrame& message) {
  BuiltFrame frame{.sensor = message.sensor,
                   .stamp_ns = message.stamp_ns,
                   .scene_revision = message.scene_revision,
                   .place = from_wire(message.place),
                   .carrier = {static_cast<RobotBase::Kind>(message.carrier.kind),
                               message.carrier.object, message.carrier.robot, message.carrier.link},
                   .postures = {},
                   .camera = {.width = message.width,
                              .height = message.height,
                              .fx = message.fx,
                              .fy = message.fy,
                              .cx = message.cx,
                              .cy = message.cy},
                   .message = {.type = static_cast<RawSensorMessage::Type>(message.kind)}};
  for (const clearance_msg_PastJoint& joint :
       std::span(message.joints._buffer, message.joints._length)) {
    frame.postures.joints.push_back({joint.known, joint.position, joint.may_have_moved});
  }
  for (const clearance_msg_PastBody& object :
       std::span(message.objects._buffer, message.objects._length)) {
    frame.postures.objects.push_back(from_wire(object));
  }
  const auto bytes = std::as_bytes(std::span(message.message._buffer, message.message._length));
  frame.message.cdr.assign(bytes.begin(), bytes.end());
  return frame;
}

}  // namespace clearance
