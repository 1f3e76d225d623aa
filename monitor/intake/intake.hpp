// The one way in: raw messages of any topic become batches that the tick takes, and news for a
// person. Knows neither DDS nor a clock nor a file, so that everything that reads inputs can use
// it: the daemon, bags, recordings, and whatever draws them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/pose_sources.hpp"
#include "monitor/intake/ros_joint_states.hpp"
#include "monitor/intake/ros_transforms.hpp"
#include "monitor/intake/slow_inputs.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

struct IntakeOptions {
  // The messages come out of a log: in its order, with times of recording, from writers that nobody
  // knows any more.
  bool is_log = false;
  // Whether sources are admitted as the daemon does it: at most kMaxSources, each of one writer.
  bool admits_sources = false;
  // What a batch may hold; more is counted and left out.
  std::size_t most_samples = std::numeric_limits<std::size_t>::max();
  std::size_t most_joints = std::numeric_limits<std::size_t>::max();
  // Of ROS 2's joint states: see RosJointStatesOptions.
  std::vector<std::string> joint_topics = {};
  // How a person knows a writer, for news.
  std::function<std::string(std::uint64_t)> writer_name = [](std::uint64_t writer) {
    return std::to_string(writer);
  };
};

// For one thread at a time.
class Intake final : public Outlet {
 public:
  // Gets each batch that was admitted; may exchange its content for other memory. False: there is
  // no room for it, it is lost.
  using Use = std::function<bool(PoseBatch& batch)>;

  // The cell must outlive this.
  Intake(const Cell& cell, IntakeOptions options, Use use);

  struct Topic {
    std::uint32_t number = 0;           // for RawMessage::topic
    const RosType* delivery = nullptr;  // null: one of ours
  };
  // Nothing: the topic says nothing that the cell could use.
  [[nodiscard]] std::optional<Topic> topic(const TopicName& name);
  // One of our own, as the cell names it.
  [[nodiscard]] std::optional<Topic> topic(TopicKind kind);

  // Whether any topic of ROS 2 could be wanted.
  [[nodiscard]] bool hears_ros() const noexcept {
    return !scene_.robots.empty() || transforms_->any();
  }

  // False: the bytes are no message of the topic's type.
  bool take(const RawMessage& message, const Now& now);
  // To be called after all messages that had come, and at the latest after patience_ns().
  void settle(const Now& now);
  [[nodiscard]] std::int64_t patience_ns() const;
  // Only these writers are still there: names and places of others are free.
  void keep(std::vector<std::uint64_t> writers);

  // What was told since the last call.
  [[nodiscard]] std::vector<News> take_news();

  [[nodiscard]] const TopicCounts& counts(std::uint32_t topic) const {
    return routes_[topic].counts;
  }
  [[nodiscard]] const PoseSources& sources() const noexcept { return sources_; }
  [[nodiscard]] const RosJointStates& joint_states() const noexcept { return *joint_states_; }
  [[nodiscard]] const RosTransforms& transforms() const noexcept { return *transforms_; }

 private:
  struct Route {
    Decoder* decoder = nullptr;
    Decoder::Wanted wanted;
    TopicCounts counts;
  };

  template <class Kind, class... Arguments>
  const Kind* add(Arguments&&... arguments);
  void give(PoseBatch& batch, std::uint64_t writer, std::size_t cut) override;
  void tell(News news) override { news_.push_back(std::move(news)); }
  // Null: refused.
  [[nodiscard]] SourceTally* admit(const PoseBatch& batch, std::uint64_t writer, std::size_t size);
  void tell_of(const Admission& admission, const PoseBatch& batch, std::uint64_t writer);

  const Scene& scene_;
  const Topics& topics_;
  IntakeOptions options_;
  Use use_;
  std::vector<std::unique_ptr<Decoder>> decoders_;
  const RosJointStates* joint_states_ = nullptr;                          // of decoders_
  const RosTransforms* transforms_ = nullptr;                             // of decoders_
  std::vector<Route> routes_;                                             // by number of the topic
  std::map<std::pair<std::string, std::string>, std::uint32_t> numbers_;  // by name and type
  PoseSources sources_;
  SlowInputs slow_;
  std::vector<News> news_;
  std::int64_t monotonic_ns_ = 0;  // of what is being taken
};

}  // namespace clearance
