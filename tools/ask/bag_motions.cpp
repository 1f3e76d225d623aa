#include "tools/ask/bag_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "monitor/bags/bag.hpp"
#include "monitor/intake/ros_joint_trajectory.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTrajectory = "trajectory_msgs/msg/JointTrajectory";
constexpr std::string_view kJointStates = "sensor_msgs/msg/JointState";

class Reader {
 public:
  // Returns a motion if the message is one.
  std::optional<BagMotion> take(const BagMessage& message) {
    if (!first_ns_) first_ns_ = message.log_ns;
    if (message.topic->type == kJointStates) note_joints(message);
    if (message.topic->type != kTrajectory) return std::nullopt;
    BagMotion found{fmt::format("{} at {:.3f} s", message.topic->name,
                                1e-9 * static_cast<double>(message.log_ns - *first_ns_))};
    found.log_ns = message.log_ns;
    std::vector<HeldJoint> present;
    for (const auto& [name, joint] : joints_) {
      present.push_back({name, joint.position});
      const std::int64_t age_ns = std::max<std::int64_t>(0, message.log_ns - joint.stamp_ns);
      found.joints.push_back({name, joint.position, 1e-9 * static_cast<double>(age_ns)});
    }
    if (!decoder_.decode(message.payload, trajectory_)) {
      found.motion = "found bytes that do not decode; expected a JointTrajectory";
      return found;
    }
    found.motion = motion_of(*trajectory_, present);
    if (const auto* motion = std::get_if<JointTrajectory>(&found.motion)) {
      std::erase_if(found.joints, [&](const StatedJoint& joint) {
        return std::ranges::find(motion->joints, joint.name) != motion->joints.end();
      });
    }
    return found;
  }

 private:
  void note_joints(const BagMessage& message) {
    if (!decoder_.decode(message.payload, states_)) return;
    const std::uint32_t count = std::min(states_->name._length, states_->position._length);
    const auto& stamp = states_->header.stamp;
    const std::int64_t stated_ns = 1'000'000'000LL * stamp.sec + stamp.nanosec;
    const std::int64_t stamp_ns = stated_ns == 0 ? message.log_ns : stated_ns;
    for (std::uint32_t i = 0; i < count; ++i)
      joints_[states_->name._buffer[i]] = {states_->position._buffer[i], stamp_ns};
  }

  std::optional<std::int64_t> first_ns_;
  struct Joint {
    double position;
    std::int64_t stamp_ns;
  };
  std::map<std::string, Joint> joints_;
  CdrDecoder decoder_;
  Sample<trajectory_msgs_msg_dds__JointTrajectory_> trajectory_;
  Sample<sensor_msgs_msg_dds__JointState_> states_;
};

}  // namespace

std::string for_each_motion(const std::filesystem::path& bag,
                            const std::function<void(const BagMotion&)>& take) {
  const std::unique_ptr<Bag> file = open_bag(bag);
  Reader reader;
  BagMessage message;
  while (file->next(message)) {
    if (const auto motion = reader.take(message)) take(*motion);
  }
  return file->error();
}

}  // namespace clearance
