// The transforms of ROS 2, /tf and /tf_static, as poses of what of a cell follows frames.
//
// A frame belongs to the publisher that sent it first, as long as that publisher is there and, on
// /tf, has been silent for less than a second. A pose is handed over when the stamp of its chain
// changes, which is that of the oldest transform of the chain. A chain of which no transform may
// change holds always, and its pose is handed over again before it is late.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/intake/decoder.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tracked_frames.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

// A log is replayed message by message: every message of any namespace's tf says of all followers
// where they are. Objects that name no frame follow the frame of their name.
enum class TransformsFrom : std::uint8_t { kPublishers, kLog };

class RosTransforms final : public Decoder {
 public:
  // Whose batches these are, as of a writer: there are many, and what is composed of several is no
  // one's.
  static constexpr std::uint64_t kWriter = ~std::uint64_t{0};
  static constexpr std::size_t kMostFrames = 4096;
  // A publisher that has been silent for this long gives its frames up.
  static constexpr std::int64_t kFrameHeldNs = 1'000'000'000;
  // What is missing for this long is told.
  static constexpr std::int64_t kMissingNs = 5'000'000'000;

  // The cell and the outlet must outlive this.
  RosTransforms(const Cell& cell, TransformsFrom from, Outlet& out);

  [[nodiscard]] std::optional<Wanted> wants(const TopicName& topic) override;
  [[nodiscard]] bool decode(std::uint32_t port, const RawMessage& message, const Now& now,
                            TopicCounts& counts) override;
  // Hands over what has changed, and tells what is missing.
  void settle(const Now& now) override;
  [[nodiscard]] std::int64_t patience_ns() const override;
  void keep(std::span<const std::uint64_t> writers) override;

  // Whether anything of the cell follows frames.
  [[nodiscard]] bool any() const noexcept { return frames_.any(); }
  // Roots of trees that were taken to be the cell's world, which has no name.
  [[nodiscard]] std::vector<std::string> worlds() const;

 private:
  enum class State : std::uint8_t { kFine, kMissing, kCircle, kElsewhere };
  struct Owner {
    std::uint64_t writer = 0;
    std::int64_t last_ns = 0;  // monotonic
    bool is_static = false, rival_said = false;
  };
  struct Following {
    std::int64_t stamp_ns = 0;        // handed over last
    std::int64_t handed_over_ns = 0;  // monotonic
    State state = State::kFine;
    std::int64_t since_ns = -1;  // monotonic; negative: nobody has looked yet
    bool said = false;           // of this state
    bool is_lost = false;        // something was said since it was fine
  };
  using Transform = geometry_msgs_msg_dds__TransformStamped_;
  struct Topic {
    std::string name, source;
    bool is_static = false;
  };

  void take(const Transform& transform, const Topic& topic, const RawMessage& message,
            const Now& now, TopicCounts& counts);
  [[nodiscard]] bool is_usable(const std::string& child, const TfTree::Link& link);
  [[nodiscard]] bool admits(const std::string& child, const TfTree::Link& link,
                            std::uint64_t writer, bool is_static, const Now& now);
  void note_parent(const std::string& child, const std::string& parent);
  void hand_over(const std::string& source, const Now& now);
  void give(PoseBatch& batch, const std::string& source);
  [[nodiscard]] State follow(std::size_t follower, const Now& now);
  [[nodiscard]] bool is_due(const TrackedFrames::Follower& of, const TfTree::Place& place,
                            const Following& following, const Now& now) const;
  void note(std::size_t follower, State state, const Now& now);
  [[nodiscard]] std::string what_is_wrong(const TrackedFrames::Follower& follower,
                                          State state) const;

  const RosSettings& ros_;
  TransformsFrom from_;
  Outlet& out_;
  TrackedFrames frames_;
  std::vector<Topic> topics_;  // by port
  CdrDecoder decoder_;
  Sample<tf2_msgs_msg_dds__TFMessage_> message_;
  TfTree tree_;
  std::vector<std::uint64_t> writers_;               // that are there, sorted
  std::map<std::string, Owner> owners_;              // by child
  std::map<std::uint64_t, StampCheck> stamps_;       // by publisher
  std::map<std::string, std::size_t> parents_said_;  // changes of a child's parent
  std::set<std::string> refused_said_;               // children
  std::set<std::string> roots_;                      // where chains of followers end
  bool too_many_said_ = false;
  std::vector<Following> following_;              // by follower
  std::map<std::string, std::uint64_t> numbers_;  // of batches, by source
  PoseBatch poses_, base_;
};

}  // namespace clearance
