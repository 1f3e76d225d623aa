// Joins what the daemons of the shares of one cell say, without DDS: one report, one state of each
// zone, one health. Whatever hangs on a share that is not heard is unknown.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clearance.h"

namespace clearance::client {

// The values of ShareHealth::state on the wire.
enum class ShareState : std::uint8_t {
  kWhole = 0,          // its reports are used
  kMissing = 1,        // none has come, or its daemon has died or hangs
  kLate = 2,           // its last report is too old, or its clock disagrees with ours
  kOtherRevision = 3,  // it has another scene than the others, or one that is not known yet
  kOtherDivision = 4,  // it divides this scene otherwise: a pair may be in no share
  kHeld = 5,           // two of its messages were faulty: until SharedCell::acknowledge()
};
// "whole", "missing", ...
[[nodiscard]] const char* name(ShareState state) noexcept;

// A share at one moment.
struct ShareView {
  ShareState state = ShareState::kMissing;
  const clearance_msg_Distances* report = nullptr;       // kWhole: not null
  const clearance_msg_Separation* separation = nullptr;  // null: it has none, or none of that time
  const clearance_msg_Gradients* gradients = nullptr;    // likewise
};

// A hash of the division of a scene: the names of the shares, and the share of each pair.
[[nodiscard]] std::uint64_t division_of(const clearance_msg_Catalogue& catalogue);

// Knows which pairs and zones of a scene depend on which share.
class ShareMap {
 public:
  ShareMap() = default;
  // The catalogue has `shares`.
  explicit ShareMap(const clearance_msg_Catalogue& catalogue);

  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  [[nodiscard]] std::uint64_t division() const noexcept { return division_; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
  [[nodiscard]] std::uint32_t pairs(std::size_t share) const { return pairs_[share]; }
  // Published pairs, ascending, and the share of each.
  struct Published {
    std::uint32_t pair = 0;
    std::uint8_t share = 0;
  };
  [[nodiscard]] std::span<const Published> published() const noexcept { return published_; }
  // By zone: the shares that have pairs of it, ascending.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& zones() const noexcept {
    return zones_;
  }
  // The zones with `separation` that have a pair of any share, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& separated() const noexcept { return separated_; }
  // The robots that state how they stop, as indices into Scene::robots, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& stopping() const noexcept { return stopping_; }
  // The first pair of a share in the cell, for a zone that is active because of it.
  [[nodiscard]] std::uint32_t first_pair(std::size_t share) const { return first_pairs_[share]; }

 private:
  std::uint64_t revision_ = 0, division_ = 0;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> pairs_, first_pairs_;
  std::vector<Published> published_;
  std::vector<std::vector<std::size_t>> zones_;
  std::vector<std::uint32_t> separated_, stopping_;
};

// Fills `out` with the report of the whole cell. One view a share, in the order of the map.
//  - A pair of a share that is not whole is unknown, and so is a published one that its share does
//    not report. `lower_all` is -infinity then, and no minimum is certified.
//  - The minimum is the one of the shares with the least upper bound. It is certified if no other
//    share can have a nearer pair.
//  - `now_ns` and `publish_ns` are the oldest of the shares: a report is no younger than its oldest
//    part. Bounds of different shares hold for the poses of different ticks, up to that far apart.
//  - Counts are sums. `daemon`, `cycle` and `changes_since` are left to the caller.
void join_reports(const ShareMap& map, std::span<const ShareView> views,
                  clearance_msg_Distances& out);

// The same for separations, with an entry for each of map.separated() and map.stopping(). A zone of
// a share that is not whole, or that has no separation of the time of its report, has validity 0
// and scaling 0, as its pairs. If there is such a share, so has each robot. Otherwise the share
// with the least scaling counts. Of validity, clearance and share of the motion, the least of all
// counts, and of the times of stops the longest.
void join_separations(const ShareMap& map, std::span<const ShareView> views,
                      clearance_msg_Separation& out);

// Fills an empty message with the pairs of all shares that are whole and have gradients, in the
// order of the cell. Pairs of other shares are left out.
void join_gradients(const ShareMap& map, std::span<const ShareView> views,
                    clearance_msg_Gradients& out);

// The state of a zone by those of its shares; null: not known. It is active if one of them is, or
// if one or the zone is not known (ZoneCause::kNoShare). The least clearance decides what it says.
[[nodiscard]] clearance_msg_ZoneState join_zone(
    const ShareMap& map, std::uint32_t zone,
    std::span<const clearance_msg_ZoneState* const> of_shares);

// The counts of all daemons of one share since the first one was heard. They do not fall where
// another daemon follows, as after a restart or a change of the leader: what that had counted
// before is left out.
class HealthCounts {
 public:
  void take(const clearance_msg_Health& health);
  void add_to(clearance_msg_Health& sums) const;
  struct Refused {
    std::uint64_t count = 0;
    std::string last;  // RejectCount::last, where one is known
    void add(const Refused& more) {
      count += more.count;
      if (!more.last.empty()) last = more.last;
    }
  };
  using Rejected = std::map<std::pair<std::string, std::string>, Refused>;  // object, cause
  [[nodiscard]] const Rejected& rejected() const noexcept { return told_.rejected; }

 private:
  struct Counts {
    std::vector<std::uint64_t> all;
    Rejected rejected;
  };
  std::uint64_t daemon_ = 0;  // that of the last one
  Counts last_, told_;
};

// The ages of inputs are the largest that any share has, times are the largest, and counts are the
// sums of `counts`. One health a share; null: none has come, or the share is not whole. The
// partners of the share that is the worst off are told, with the counts of all. `shares` is left to
// the caller.
void join_health(std::span<const clearance_msg_Health* const> of_shares,
                 std::span<const HealthCounts* const> counts, clearance_msg_Health& out);

}  // namespace clearance::client
