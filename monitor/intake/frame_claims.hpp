// The publishers of each frame of tf, and the tree of those that are used.
//
// The transform of a frame that one publisher sends is a claim. If several publishers claim a
// frame, one of them is used, and the others are its rivals. The poses that follow from a rival's
// claim are handed over under another source name. The tick thus sees that two sources send one
// object, and trusts neither while they disagree (inputs/input_record.hpp).
//
// Claims on tf go before those on tf_static, whichever came first: "source: /tf" in a cell then
// means the same at every start. Among claims of one kind the first one that was heard is used, as
// long as its publisher exists. A publisher on tf must also not be silent for a second or more.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "monitor/intake/tf_tree.hpp"

namespace clearance {

class FrameClaims {
 public:
  static constexpr std::size_t kMostFrames = 4096;
  static constexpr std::size_t kMostClaims = 4;  // for one frame; more say nothing new
  // A publisher on tf that is silent for this long does not count.
  static constexpr std::int64_t kSilentNs = 1'000'000'000;

  struct Publisher {
    std::uint64_t writer = 0;
    std::uint32_t port = 0;  // of its topic
    bool is_static = false;
    bool operator==(const Publisher&) const = default;
  };
  struct Claim {
    Publisher publisher;
    // Appended to the source name of the poses that follow from this claim. The first claim has an
    // empty suffix. One on tf_static that has rivals on tf has "_static". Further claims have "#2"
    // and so on.
    std::string suffix;
    TfTree::Link link;
    std::int64_t heard_ns = 0;  // monotonic
  };

  // True if the frame is new, and there are too many.
  [[nodiscard]] bool is_one_too_many(const std::string& child) const {
    return claims_.size() >= kMostFrames && !claims_.contains(child);
  }
  // Returns true if this publisher is a rival of the one that is used, and says something else.
  bool set(const std::string& child, const Publisher& publisher, TfTree::Link link,
           std::int64_t monotonic_ns);
  // Forgets the claims of publishers that have left. `writers` are those that exist; sorted.
  void keep(std::span<const std::uint64_t> writers);
  // Chooses the claims that are used at this time.
  void settle(std::int64_t monotonic_ns);

  // The claims that are used, at the last settle() or set().
  [[nodiscard]] const TfTree& tree() const noexcept { return tree_; }
  // The claims of a frame; the one that is used comes first. Empty: no program sends the frame.
  [[nodiscard]] std::span<const Claim> claims(const std::string& child) const;
  // The frames on the path from this one to the root of its tree that several publishers claim, or
  // whose only claim has a suffix.
  [[nodiscard]] std::vector<std::string> disputed_on(const std::string& frame) const;
  // True if the claim counts at this time: its publisher is not silent.
  [[nodiscard]] static bool is_live(const Claim& claim, std::int64_t monotonic_ns) noexcept {
    return claim.publisher.is_static || monotonic_ns - claim.heard_ns < kSilentNs;
  }

 private:
  using Claims = std::vector<Claim>;
  static void choose(Claims& claims, std::int64_t monotonic_ns);
  static Claim& add(const Publisher& publisher, Claims& claims);

  TfTree tree_;
  std::map<std::string, Claims> claims_;  // by child frame
  std::set<std::string> disputed_;        // frames with several claims, or one with a suffix
};

}  // namespace clearance
