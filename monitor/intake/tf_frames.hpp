// The frames of tf: who publishes each of them, the tree of those that are used, and where they
// were at past times.
//
// The transform of a frame that one publisher sends is a claim. If several publishers claim a
// frame, one of them is used, and the others are its rivals. The poses that follow from a rival's
// claim are handed over under another source name. Who judges them thus sees that two sources send
// one pose, and trusts neither while they disagree (inputs/input_record.hpp).
//
// Claims on tf go before those on tf_static, whichever came first: "source: /tf" in a cell then
// means the same at every start. Among claims of one kind the first one that was heard is used, as
// long as its publisher exists. A publisher on tf must also not be silent for a second or more.
//
// Between two transforms to one parent, a frame is on the straight line between them. It is taken
// to be within the ball whose diameter is that line, since tf states no speed: it may begin to
// move, or stop, at any time in between. After the last transform, its place is not known.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "monitor/inputs/input_owner.hpp"
#include "monitor/intake/pose_series.hpp"
#include "monitor/intake/tf_tree.hpp"

namespace clearance {

class TfFrames {
 public:
  static constexpr std::size_t kMostFrames = 4096;
  static constexpr std::size_t kMostClaims = 4;  // for one frame; more say nothing new
  static constexpr std::size_t kFewKept = 64;

  // `kept`: the number of transforms of each claim that can be asked for by their time.
  explicit TfFrames(std::size_t kept = kFewKept) : kept_(kept) {}

  struct Publisher {
    std::uint64_t writer = 0;
    std::uint32_t port = 0;  // of its topic
    bool is_static = false;
    bool operator==(const Publisher&) const = default;
  };
  // Consecutive transforms to one parent. Those of a static frame have no stamps: the last counts.
  struct Stretch {
    std::string parent;
    PoseSeries poses{1};
  };
  struct Claim {
    Publisher publisher;
    // Appended to the source name of the poses that follow from this claim. The first claim has an
    // empty suffix. One on tf_static that has rivals on tf has "_static". Further claims have "#2"
    // and so on.
    std::string suffix;
    TfTree::Link link;
    std::int64_t heard_ns = 0;  // monotonic
    Stretch last, before;       // the last transforms, and those to the parent before
  };

  // True if the transform is a pose, and its frames have names.
  [[nodiscard]] static bool is_transform(const std::string& child,
                                         const TfTree::Link& link) noexcept;
  // The frames that one message places twice at one time, and not alike: neither could be meant.
  // All transforms of a static frame are of one time.
  [[nodiscard]] static std::set<std::string> placed_twice(
      const tf2_msgs_msg_dds__TFMessage_& message, bool is_static);
  // True if the frame is new, and there are too many. Transforms that are kept need memory.
  [[nodiscard]] bool is_one_too_many(const std::string& child) const {
    const std::size_t most = kept_ > kFewKept ? kMostFrames / 4 : kMostFrames;
    return frames_.size() >= most && !frames_.contains(child);
  }
  // Returns true if this publisher is a rival of the one that is used, and says something else.
  bool set(const std::string& child, const Publisher& publisher, TfTree::Link link,
           std::int64_t monotonic_ns);
  // Forgets the claims of publishers that have left. `writers` are those that exist; sorted. A
  // frame without any keeps its last transforms.
  void keep(std::span<const std::uint64_t> writers);
  // Chooses the claims that are used at this time.
  void settle(std::int64_t monotonic_ns);
  // This machine's clock was set back: stamps say nothing about times that come again.
  void forget();

  // The claims that are used, at the last settle() or set().
  [[nodiscard]] const TfTree& tree() const noexcept { return tree_; }
  // The claims of a frame; the one that is used comes first. Empty: no program sends the frame.
  [[nodiscard]] std::span<const Claim> claims(const std::string& child) const;
  // The claim that is used, also if its publisher has left; null: there is none.
  [[nodiscard]] const Claim* used(const std::string& child) const;
  // The frames on the path from this one to the root of its tree that several publishers claim, or
  // whose only claim has a suffix.
  [[nodiscard]] std::vector<std::string> disputed_on(const std::string& frame) const;
  // True if the claim counts at this time: its publisher is not silent.
  [[nodiscard]] static bool is_live(const Claim& claim, std::int64_t monotonic_ns) noexcept {
    return claim.publisher.is_static || monotonic_ns - claim.heard_ns < kSourceSilentNs;
  }

  // The parent that a claim names for a past time.
  struct Parent {
    const std::string* name = nullptr;
    std::int64_t known_until_ns = 0;  // the stamp of its last transform; if static, the last time
  };
  // Nothing: there was no transform, or the frame got this parent after that time.
  [[nodiscard]] static std::optional<Parent> parent(const Claim& claim, std::int64_t stamp_ns);
  struct Step {
    Pose parent_from_child;
    double shift_error = 0.0, turn_error = 0.0;  // m, rad
    std::int64_t longest_ns = 0;                 // between two transforms around that time
  };
  // Returns nothing if the frame has no place at that time, which is known to `within_ns`: the
  // errors enclose its motion within.
  [[nodiscard]] static std::optional<Step> step(const Claim& claim, std::int64_t stamp_ns,
                                                std::int64_t within_ns = 0);
  // Returns the pose of the claim's frame in that parent at that time; nothing: not known.
  [[nodiscard]] static std::optional<Pose> pose_in(const std::string& parent, const Claim& claim,
                                                   std::int64_t stamp_ns);
  // Appends the stamps of the transforms from the first time to the last one, and those of the two
  // around these times. A static frame has none.
  static void append_stamps(const Claim& claim, std::int64_t first_ns, std::int64_t last_ns,
                            std::vector<std::int64_t>& stamps);

 private:
  struct Frame {
    std::vector<Claim> claims;
    std::optional<Claim> left;  // the last one, whose publisher has left
  };
  static void choose(std::vector<Claim>& claims, std::int64_t monotonic_ns);
  static Claim& add(const Publisher& publisher, Frame& frame);
  void note(Claim& claim) const;
  [[nodiscard]] static const Stretch* stretch(const Claim& claim, std::int64_t stamp_ns) noexcept;

  std::size_t kept_;
  TfTree tree_;
  std::map<std::string, Frame> frames_;  // by child frame
  std::set<std::string> disputed_;       // frames with several claims, or one with a suffix
};

}  // namespace clearance
