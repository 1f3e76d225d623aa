// The transforms of ROS 2, rt/tf and rt/tf_static, as poses of what of a cell follows frames.
//
// A frame belongs to the publisher that sent it first, as long as it is there and, on tf, has been
// silent for less than a second. A pose is handed over when the stamp of its way changes, which is
// that of the oldest transform on it; one of which no transform may change holds always, and is
// handed over again before it is late.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/dds/present_topics.hpp"
#include "monitor/dds/ros_stamps.hpp"
#include "monitor/frames/tracked_frames.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// For one thread.
class RosTransforms {
 public:
  // Whose samples these are, as of a DDS writer: there are many, and what is composed of several is
  // no one's.
  static constexpr std::uint64_t kWriter = ~std::uint64_t{0};
  static constexpr std::size_t kMostFrames = 4096;
  // A publisher that has been silent for this long gives its frames up.
  static constexpr std::int64_t kFrameHeldNs = 1'000'000'000;
  // What is missing for this long is named in the log.
  static constexpr std::int64_t kMissingNs = 5'000'000'000;

  // Makes readers where something follows frames. All three must outlive this.
  RosTransforms(const Scene& scene, Participant& participant, const PresentTopics& present);
  ~RosTransforms();
  RosTransforms(const RosTransforms&) = delete;
  RosTransforms& operator=(const RosTransforms&) = delete;

  [[nodiscard]] bool any() const noexcept { return frames_.any(); }
  [[nodiscard]] std::vector<dds_entity_t> readers() const;
  // How long take_all() may wait for news; infinite where nothing follows frames.
  [[nodiscard]] std::int64_t patience_ns() const noexcept;

  // Forgets publishers that have left.
  void look();
  // Takes what has come, hands over what it changes, and tells the log what is missing.
  void take_all(const std::function<void(const PoseBatch&)>& hand_over);

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
    std::int64_t since_ns;  // monotonic
    bool said = false;      // of this state
    bool is_lost = false;   // something was said since it was fine
  };
  using Transform = geometry_msgs_msg_dds__TransformStamped_;

  void take(dds_entity_t reader, bool is_static);
  void take(const Transform& transform, std::int64_t sent_ns, std::uint64_t writer, bool is_static);
  [[nodiscard]] bool is_usable(const std::string& child, const TfTree::Link& link);
  [[nodiscard]] bool admits(const std::string& child, const TfTree::Link& link,
                            std::uint64_t writer, bool is_static);
  void note_parent(const std::string& child, const std::string& parent);
  [[nodiscard]] State follow(std::size_t follower);
  void note(std::size_t follower, State state);
  [[nodiscard]] std::string what_is_wrong(const TrackedFrames::Follower& follower,
                                          State state) const;

  const Scene& scene_;
  const PresentTopics& present_;
  std::string where_;
  TrackedFrames frames_;
  dds_entity_t reader_ = 0, static_reader_ = 0;
  TfTree tree_;
  std::map<std::string, Owner> owners_;              // by child
  std::map<std::uint64_t, RosStampCheck> stamps_;    // by publisher
  std::map<std::string, std::size_t> parents_said_;  // changes of a child's parent
  std::set<std::string> refused_said_;               // children
  bool too_many_said_ = false;
  std::vector<Following> following_;  // by follower
  std::int64_t now_ns_ = 0;           // monotonic, of this call
  PoseBatch poses_, bases_;
};

}  // namespace clearance
