// Converts the joint states and transforms of a bag to batches of the tick's inputs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "monitor/inputs/simulated_time.hpp"
#include "monitor/intake/intake.hpp"
#include "monitor/recording/bag.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// Joint states move the joints of the cell's robots exactly like those from DDS. The topics /tf and
// /tf_static place the objects and robot bases that follow frames. They also place moving objects
// that are not links and have the name of a frame. Without a `world_frame`, the root of the frames
// is taken to be the cell's world. Each topic is a source under its own name; tf_static belongs to
// the source of tf.
//
// A stamp of 0, or one more than 10 s off the recorder's clock, does not tell when a position held.
// The time of recording is used instead.
//
// If the cell has `use_sim_time`, all times are those of /clock in the bag, as in the daemon.
// Without a message of /clock, those of recording are taken to be its times: that is how a recorder
// with `use_sim_time` writes them, and what a player publishes. A stamp that is ahead of the clock
// leads the time (SimulatedTime::lead()), and no batch comes before such a stamp.
//
// A message is decoded when it is given out, by the cell that is in force then. Time passes between
// two messages as well, so that what falls silent is told as in the daemon.
class BagLog final : public InputLog {
 public:
  BagLog(const std::filesystem::path& path, const Cell& cell, const InputLogOptions& options);

  [[nodiscard]] bool next(LoggedBatch& batch) override;
  void change(const Cell& cell) override;
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
    BagTopic of;
    std::optional<std::uint32_t> number;  // the intake's number; nothing: not used
    std::uint64_t messages = 0;
    std::uint64_t empty = 0;  // joint states without a position of a joint of the cell
  };

  // A message of a topic that is used.
  struct Message {
    Topic* topic = nullptr;
    std::int64_t log_ns = 0;
    std::vector<std::byte> payload;
  };

  void read_ahead();
  void keep(const BagMessage& message);
  void choose(Topic& topic);
  [[nodiscard]] bool let_time_pass(std::int64_t until_ns);
  [[nodiscard]] std::multimap<std::int64_t, Message>::iterator next_waiting();
  void take(const Message& message);
  [[nodiscard]] std::int64_t note_time();
  void end_run(std::int64_t clock_ns);
  [[nodiscard]] std::int64_t time_ns() noexcept;
  void settle();
  [[nodiscard]] GivenJoints given_of(const Scene& scene) const;
  void use(PoseBatch batch);
  void use(moveit::RawScene message);
  void use(RawSensorMessage message);
  void lead(const RawSensorMessage& message);
  template <class IsListed>
  [[nodiscard]] std::vector<std::string> topics(const IsListed& is_listed) const;
  [[nodiscard]] std::string nothing_of_use() const;

  const Cell* cell_;
  InputLogOptions options_;
  std::filesystem::path path_;
  std::unique_ptr<Bag> bag_;
  std::unique_ptr<SimulatedTime> time_;  // null: the times are those of recording
  Intake intake_;
  CdrDecoder decoder_;

  std::map<std::string, Topic> topics_;  // by name
  std::set<std::string> heard_;          // joints
  std::vector<std::string> told_;        // sentences about rare inputs and unused topics
  std::map<std::string, std::uint64_t, std::less<>> sequence_;  // by source
  std::multimap<std::int64_t, Message> waiting_;                // by log time; ties in file order
  std::deque<LoggedBatch> decoded_;
  Topic* topic_ = nullptr;                     // topic of the message that was taken last
  std::int64_t log_ns_ = 0;                    // the time that has come; never decreases
  std::int64_t read_to_ns_ = 0, last_ns_ = 0;  // last_ns_: the time of that message
  std::int64_t given_ns_ = 0;                  // the time of the batch that was decoded last
  bool has_clock_ = false;                     // it has messages of /clock that are used
  GivenJoints given_;
  bool ended_ = false, given_out_ = false;
  std::string error_;
};

}  // namespace clearance
