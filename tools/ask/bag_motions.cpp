#include "tools/ask/bag_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "monitor/intake/intake.hpp"
#include "monitor/intake/ros_joint_trajectory.hpp"
#include "monitor/recording/bag.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTrajectory = "trajectory_msgs/msg/JointTrajectory";
constexpr std::string_view kJointStates = "sensor_msgs/msg/JointState";

class Reader {
 public:
  explicit Reader(const Cell& cell)
      : scene_(cell.scene), intake_(cell, {.is_log = true}, [this](const PoseBatch& batch) {
          for (const JointSample& sample : batch.joints)
            joints_[scene_.variables[sample.variable].name] = {sample.position, sample.stamp_ns};
          return true;
        }) {}

  // Returns a motion if the message is one.
  std::optional<BagMotion> read(const BagMessage& message) {
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
  struct Joint {
    double position;
    std::int64_t stamp_ns;
  };

  void note_joints(const BagMessage& message) {
    const auto topic = message.topic->encoding == "cdr"
                           ? intake_.topic({message.topic->name, message.topic->type})
                           : std::nullopt;
    if (!topic) return;
    static_cast<void>(
        intake_.take({.topic = topic->number, .cdr = message.payload, .sent_ns = message.log_ns},
                     {.realtime_ns = message.log_ns, .monotonic_ns = message.log_ns}));
  }

  std::optional<std::int64_t> first_ns_;
  const Scene& scene_;
  std::map<std::string, Joint> joints_;  // by the name of the variable
  Intake intake_;
  CdrDecoder decoder_;
  Sample<trajectory_msgs_msg_dds__JointTrajectory_> trajectory_;
};

}  // namespace

std::string for_each_motion(const Cell& cell, const std::filesystem::path& bag,
                            const std::function<void(const BagMotion&)>& use) {
  const std::unique_ptr<Bag> file = open_bag(bag);
  Reader reader(cell);
  BagMessage message;
  while (file->next(message)) {
    if (const auto motion = reader.read(message)) use(*motion);
  }
  return file->error();
}

}  // namespace clearance
