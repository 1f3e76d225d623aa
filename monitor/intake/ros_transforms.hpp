// Converts the transforms of ROS 2, /tf and /tf_static, to poses of the cell's followers: the
// objects and robot bases that follow frames.
//
// If several publishers send a frame, the poses by each of them are handed over, under source names
// of their own (tf_frames.hpp). The stamp of a chain of transforms is that of its oldest one. A
// follower's pose is handed over when that stamp changes. A chain of static transforms is always
// valid: its pose is handed over again before it is late.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/sensor_messages.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_frames.hpp"
#include "monitor/intake/tracked_frames.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A log is replayed message by message, and has tf in any namespace. In a log, objects that name no
// frame follow the frame of their own name.
enum class TransformsFrom : std::uint8_t { kPublishers, kLog };

class RosTransforms final : public Decoder {
 public:
  // The writer number of all these batches. A pose composed of several publishers' transforms has
  // no single writer.
  static constexpr std::uint64_t kWriter = ~std::uint64_t{0};
  // A transform that is missing for this long is reported.
  static constexpr std::int64_t kMissingNs = 5'000'000'000;

  // The cell and the outlet must outlive this. `use` receives every message as well, if a sensor of
  // the cell stands in a frame.
  RosTransforms(const Cell& cell, TransformsFrom from, Outlet& out, UseSensorMessage use = {});

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] std::vector<NamedTopic> named() const override {
    return any() ? transform_topics() : std::vector<NamedTopic>();
  }
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  // Hands over the changed poses, and reports missing transforms.
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;
  void keep(std::span<const std::uint64_t> writers) override;
  void change(const Cell& cell) override;

  // True if anything of the cell follows frames, or stands in one.
  [[nodiscard]] bool any() const noexcept { return frames_.any() || is_used_; }
  // The roots of trees that were taken to be the cell's world, if the cell gives its world no frame
  // name.
  [[nodiscard]] std::vector<std::string> worlds() const;

 private:
  enum class State : std::uint8_t { kFine, kMissing, kCircle, kElsewhere, kApart, kDisputed };
  // The pose handed over last.
  struct HandedOver {
    std::int64_t stamp_ns = 0;
    std::int64_t at_ns = 0;  // monotonic
  };
  // A live rival's claim of a frame on the path of a follower, and the place by it.
  struct Rival {
    std::string frame, suffix;
    std::optional<TfTree::Place> place;
    [[nodiscard]] bool has_place() const noexcept { return place && place->is_of_one_time; }
  };
  // A rival's claim of a frame on the path of a follower: follower, frame, suffix of the claim.
  using RivalPath = std::tuple<std::size_t, std::string, std::string>;
  struct Following {
    HandedOver last = {};
    State state = State::kFine;
    std::int64_t since_ns = -1;  // monotonic; negative: not checked yet
    bool said = false;           // this state was reported
    bool is_lost = false;        // a fault was reported since it was fine
  };
  using Transform = geometry_msgs_msg_dds__TransformStamped_;
  struct Topic {
    std::string name, source;
    bool is_static = false;
  };

  void take(const Transform& transform, std::uint32_t port, const RawMessage& message,
            const Now& now, TopicCounts& counts);
  [[nodiscard]] bool is_usable(const std::string& child, const TfTree::Link& link);
  void note_parent(const std::string& child, const std::string& parent);
  void hand_over(const std::string& source, const Now& now);
  void give(PoseBatch& batch, const std::string& source);
  [[nodiscard]] State follow(std::size_t follower, const std::string& source, const Now& now);
  // For every rival claim on the path to the follower's frame: hands over the pose that the
  // follower would have if that claim were used.
  void follow_rivals(std::size_t follower, const std::string& source, const Now& now);
  void add(std::size_t follower, const TfTree::Place& place, const std::string& source,
           HandedOver& last, const Now& now);
  [[nodiscard]] bool is_due(const TrackedFrames::Follower& of, const TfTree::Place& place,
                            const HandedOver& last, const Now& now) const;
  // The place by the claims that are used, or with this rival's claim of the frame `at`.
  [[nodiscard]] std::optional<TfTree::Place> find(const TrackedFrames::Follower& of,
                                                  const TfFrames::Claim* rival, std::string* root,
                                                  const std::string& at = {}) const;
  [[nodiscard]] std::vector<Rival> rivals_of(const TrackedFrames::Follower& of,
                                             const Now& now) const;
  void note(std::size_t follower, State state, const Now& now);
  [[nodiscard]] std::string what_is_wrong(const TrackedFrames::Follower& follower,
                                          State state) const;

  const RosSettings* ros_;
  TransformsFrom from_;
  Outlet& out_;
  UseSensorMessage use_;
  bool is_used_;  // by sensors
  TrackedFrames frames_;
  std::vector<Topic> topics_;  // by port
  CdrDecoder decoder_;
  Sample<tf2_msgs_msg_dds__TFMessage_> message_;
  std::set<std::string> placed_twice_;  // frames of this message
  TfFrames claims_;
  std::set<std::string> rivals_said_;                // child frames
  std::map<std::uint64_t, StampCheck> stamps_;       // by publisher
  std::map<std::string, std::size_t> parents_said_;  // number of reported parents, by child frame
  std::set<std::string> refused_said_;               // child frames
  std::set<std::string> roots_;                      // ends of the followers' chains
  std::string source_ = "/tf";                       // of the message before
  bool too_many_said_ = false;
  std::vector<Following> following_;  // by follower
  std::map<RivalPath, HandedOver> by_rivals_;
  std::map<std::string, std::uint64_t> numbers_;  // sequence numbers of batches, by source
  std::map<std::string, PoseBatch> poses_;        // by source
  PoseBatch base_;
};

}  // namespace clearance
