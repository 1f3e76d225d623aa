// The joint states and transforms of a bag as batches of the tick's inputs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "monitor/bags/bag.hpp"
#include "monitor/bags/given_joints.hpp"
#include "monitor/bags/input_log.hpp"
#include "monitor/bags/input_rate.hpp"
#include "monitor/frames/tracked_frames.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/joint_names.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {

// Joint states move the joints of the cell's robots as those that are heard on DDS do. Objects and
// bases of robots that follow frames are where /tf and /tf_static say, and so is a moving object
// that is no link of a robot and whose name is that of a frame. Without a `world_frame`, the root
// of the frames is taken to be the cell's world. Each topic is a source of its name, tf_static one
// with tf.
//
// Stamps of 0, and those of another clock than the recorder's (more than 10 s away), say nothing of
// when a position held: then the time is used at which it was recorded.
class BagLog final : public InputLog {
 public:
  BagLog(const std::filesystem::path& path, const Cell& cell, const InputLogOptions& options);

  [[nodiscard]] bool next(LoggedBatch& batch) override;
  [[nodiscard]] const std::string& error() const noexcept override;
  [[nodiscard]] bool readable() const noexcept override {
    return bag_->readable() && given_.error().empty();
  }
  [[nodiscard]] double progress() const noexcept override { return bag_->progress(); }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  enum class Use : std::uint8_t { kNothing, kJoints, kTransforms, kStaticTransforms };
  struct Topic {
    std::string type;
    Use use = Use::kNothing;
    std::optional<JointNames> names;  // of joint states: whose they are depends on the topic
    std::uint64_t messages = 0;
    std::uint64_t undecodable = 0, empty = 0, unstamped = 0, of_another_clock = 0;
    std::int64_t clock_difference_ns = 0;  // of the first such stamp
    InputRate rate;
  };

  void read_ahead();
  void take(const BagMessage& message);
  void take_joints(const BagMessage& message, Topic& topic);
  void take_transforms(const BagMessage& message, Topic& topic);
  void give(const std::string& source, std::int64_t log_ns, PoseBatch batch, Topic& topic);
  void wait(const std::string& source, std::int64_t log_ns, PoseBatch batch);
  [[nodiscard]] Use use_of(const BagTopic& topic) const;
  void note_unknown(const JointNames& names);
  [[nodiscard]] RosStamps stamps_of(const JointNames& names) const;
  [[nodiscard]] std::int64_t stamp_of(std::int64_t stamp_ns, std::int64_t log_ns, Topic& topic);
  [[nodiscard]] std::string nothing_of_use() const;

  const Scene& scene_;
  const RosSettings& ros_;
  InputLogOptions options_;
  std::filesystem::path path_;
  std::unique_ptr<Bag> bag_;
  TrackedFrames frames_;
  TfTree tree_;
  CdrDecoder decoder_;
  Sample<sensor_msgs_msg_dds__JointState_> joint_state_;
  Sample<tf2_msgs_msg_dds__TFMessage_> transforms_;
  std::set<std::string> roots_met_;

  std::map<std::string, Topic> topics_;
  std::set<std::string> unknown_joints_;
  std::vector<bool> heard_;  // by variable
  std::map<std::string, std::uint64_t> sequence_;
  std::multimap<std::int64_t, PoseBatch> waiting_;  // by log time; ties in file order
  std::int64_t read_to_ns_ = 0, last_ns_ = 0;
  GivenJoints given_;
  bool ended_ = false, given_out_ = false;
  std::string error_;
};

}  // namespace clearance
