// Converts the joint states and transforms of a bag to batches of the tick's inputs.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/intake/intake.hpp"
#include "monitor/recording/bag.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/recording/input_log.hpp"

namespace clearance {

// Joint states move the joints of the cell's robots exactly like those from DDS. The topics /tf and
// /tf_static place the objects and robot bases that follow frames. They also place moving objects
// that are not links and have the name of a frame. Without a `world_frame`, the root of the frames
// is taken to be the cell's world. Each topic is a source under its own name; tf_static belongs to
// the source of tf.
//
// A stamp of 0, or one more than 10 s off the recorder's clock, does not tell when a position held.
// The time of recording is used instead.
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
  [[nodiscard]] bool has_topics() const noexcept override { return true; }
  [[nodiscard]] std::vector<std::string> topics_of(SensorKind kind) const override;

 private:
  struct Topic {
    std::string type;
    std::optional<std::uint32_t> number;  // the intake's number; nothing: not used
    std::uint64_t messages = 0;
    std::uint64_t empty = 0;  // joint states without a position of a joint of the cell
  };

  void read_ahead();
  void take(const BagMessage& message);
  void use(PoseBatch batch);
  void use(moveit::RawScene message);
  void use(RawSensorMessage message);
  template <class IsListed>
  [[nodiscard]] std::vector<std::string> topics(const IsListed& is_listed) const;
  [[nodiscard]] std::string nothing_of_use() const;

  const Scene& scene_;
  InputLogOptions options_;
  std::filesystem::path path_;
  std::unique_ptr<Bag> bag_;
  Intake intake_;

  std::map<std::string, Topic> topics_;  // by name
  std::vector<bool> heard_;              // by variable
  std::vector<std::string> told_;        // sentences about rare inputs and unused topics
  std::map<std::string, std::uint64_t, std::less<>> sequence_;  // by source
  std::multimap<std::int64_t, LoggedBatch> waiting_;            // by log time; ties in file order
  Topic* topic_ = nullptr;   // topic of the message that is being taken
  std::int64_t log_ns_ = 0;  // of that message
  std::int64_t read_to_ns_ = 0, last_ns_ = 0;
  GivenJoints given_;
  bool ended_ = false, given_out_ = false;
  std::string error_;
};

}  // namespace clearance
