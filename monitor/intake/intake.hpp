// Turns raw messages of any topic into batches for the tick, and into news for a person. All
// readers of inputs use it: the daemon, bags, recordings and viewers. It therefore does not use
// DDS, a clock or files.
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
#include "monitor/inputs/simulated_time.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/moveit_messages.hpp"
#include "monitor/intake/pose_sources.hpp"
#include "monitor/intake/ros_joint_states.hpp"
#include "monitor/intake/ros_transforms.hpp"
#include "monitor/intake/sensor_messages.hpp"
#include "monitor/intake/slow_inputs.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

struct IntakeOptions {
  // The messages come from a log: in its order, with times of recording and without writers.
  bool is_log = false;
  // True: sources are admitted as in the daemon, at most kMaxSources, each with one writer.
  bool admits_sources = false;
  // The largest numbers of samples and joints in a batch. More are counted and left out.
  std::size_t most_samples = std::numeric_limits<std::size_t>::max();
  std::size_t most_joints = std::numeric_limits<std::size_t>::max();
  // See RosJointStatesOptions::topics.
  std::vector<std::string> joint_topics = {};
  // Receives MoveIt's messages that keep the scene. Empty: they are not used.
  MoveItMessages::Use use_scene = {};
  // Receives the messages of the cell's sensors, and the transforms that place them. Empty: they
  // are not used.
  UseSensorMessage use_sensor = {};
  // Only those: their readers have a thread of their own, since an image takes long to copy. There
  // are no batches.
  bool only_sensors = false;
  // The time of all messages, from /clock; null: that of this machine. Times of sending and of
  // arrival are converted here, so that nothing behind this knows of another time.
  SimulatedTime* time = nullptr;
  // The name of a writer in news.
  std::function<std::string(std::uint64_t)> writer_name = [](std::uint64_t writer) {
    return std::to_string(writer);
  };
};

// To be used by one thread at a time.
class Intake final : public Outlet {
 public:
  // Receives each admitted batch and may exchange its content for other memory. Returns false if
  // there is no free slot; the batch is then lost.
  using Use = std::function<bool(PoseBatch& batch)>;

  // The cell must outlive this, unless change() is called.
  Intake(const Cell& cell, IntakeOptions options, Use use);

  // The cell has changed, except for the names of its topics. Sources, sequences and transforms
  // stay known. The new cell must outlive this.
  void change(const Cell& cell);

  struct Topic {
    std::uint32_t number = 0;           // for RawMessage::topic
    const RosType* delivery = nullptr;  // null: a topic of ours
  };
  // Returns nothing if the cell cannot use the topic.
  [[nodiscard]] std::optional<Topic> topic(const TopicName& name);
  // The same for a topic of ours, under the name that the cell gives it.
  [[nodiscard]] std::optional<Topic> topic(TopicKind kind);

  // The topics of ROS 2 that the cell names.
  [[nodiscard]] std::vector<NamedTopic> named() const;

  // True if the cell could use any topic of ROS 2.
  [[nodiscard]] bool hears_ros() const noexcept {
    if (options_.only_sensors) return hears_sensors_;
    if (options_.time != nullptr) return true;
    return !scene_->variables.empty() || transforms_->any() || hears_moveit_ || hears_sensors_;
  }

  // True for the topic of a simulation's clock. Take its messages first: others are judged by it.
  [[nodiscard]] bool is_clock(std::uint32_t topic) const;
  // Returns false if the bytes are not a message of the topic's type.
  bool take(const RawMessage& message, const Now& now);
  // Call this after all available messages, and at the latest after patience_ns().
  void settle(const Now& now);
  [[nodiscard]] std::int64_t patience_ns() const;
  // `writers` are those that still exist. The names and places of all others become free.
  void keep(std::vector<std::uint64_t> writers);

  // Returns the news since the last call.
  [[nodiscard]] std::vector<News> take_news();

  [[nodiscard]] const TopicCounts& counts(std::uint32_t topic) const {
    return routes_[topic].counts;
  }
  [[nodiscard]] const PoseSources& sources() const noexcept { return sources_; }
  // Call this only without IntakeOptions::only_sensors.
  [[nodiscard]] const RosJointStates& joint_states() const noexcept { return *joint_states_; }
  [[nodiscard]] const RosTransforms& transforms() const noexcept { return *transforms_; }

 private:
  // All decoders that take a topic: MoveIt's scene may have a sensor's octomap.
  struct Route {
    struct End {
      Decoder* decoder = nullptr;
      Decoder::Wanted wanted;
    };
    std::vector<End> ends;
    TopicCounts counts;
  };

  template <class Kind, class... Arguments>
  const Kind* add(Arguments&&... arguments);
  [[nodiscard]] Now in_its_time(const Now& now) const noexcept;
  void give(PoseBatch& batch, std::uint64_t writer, std::size_t cut) override;
  void lead(const PoseBatch& batch) noexcept;
  void tell(News news) override { news_.push_back(std::move(news)); }
  // Returns null if the batch is refused. The batch of a second writer of one name gets a source
  // name of its own: the tick compares what the two say.
  [[nodiscard]] SourceTally* admit(PoseBatch& batch, std::uint64_t writer, std::size_t size);
  std::string why_refused(const Admission& admission, const SourceName& source) const;
  void tell_of(const Admission& admission, const PoseBatch& batch, std::uint64_t writer);

  const Scene* scene_;
  bool hears_moveit_, hears_sensors_;
  std::vector<std::uint64_t> former_revisions_;  // of the cells before
  const Topics* topics_;
  IntakeOptions options_;
  Use use_;
  std::vector<std::unique_ptr<Decoder>> decoders_;
  const RosJointStates* joint_states_ = nullptr;                          // an entry of decoders_
  const RosTransforms* transforms_ = nullptr;                             // an entry of decoders_
  std::vector<Route> routes_;                                             // by topic number
  std::map<std::pair<std::string, std::string>, std::uint32_t> numbers_;  // by name and type
  PoseSources sources_;
  SlowInputs slow_;
  std::vector<News> news_;
  std::int64_t monotonic_ns_ = 0;  // time of the message that is being taken
};

}  // namespace clearance
