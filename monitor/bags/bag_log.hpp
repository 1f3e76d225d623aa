// The joint states and transforms of a bag as batches of the tick's inputs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/bags/bag.hpp"
#include "monitor/bags/given_joints.hpp"
#include "monitor/bags/input_log.hpp"
#include "monitor/intake/intake.hpp"

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
  struct Topic {
    std::string type;
    std::optional<std::uint32_t> number;  // as the intake numbers it; nothing: it is not used
    std::uint64_t messages = 0;
    std::uint64_t empty = 0;  // joint states without a position of a joint of the cell
  };

  void read_ahead();
  void take(const BagMessage& message);
  void use(PoseBatch batch);
  [[nodiscard]] std::string nothing_of_use() const;

  const Scene& scene_;
  InputLogOptions options_;
  std::filesystem::path path_;
  std::unique_ptr<Bag> bag_;
  Intake intake_;

  std::map<std::string, Topic> topics_;  // by name
  std::vector<bool> heard_;              // by variable
  std::vector<std::string> slow_;        // inputs that come too seldom, a sentence each
  std::map<std::string, std::uint64_t, std::less<>> sequence_;  // by source
  std::multimap<std::int64_t, PoseBatch> waiting_;              // by log time; ties in file order
  Topic* topic_ = nullptr;   // of the message that is being taken
  std::int64_t log_ns_ = 0;  // of that message
  std::int64_t read_to_ns_ = 0, last_ns_ = 0;
  GivenJoints given_;
  bool ended_ = false, given_out_ = false;
  std::string error_;
};

}  // namespace clearance
