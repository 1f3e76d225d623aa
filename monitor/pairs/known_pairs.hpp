// How many pairs are known, and how many of them stale, without looking at pairs.
//
// What is known about a pair follows from its two objects, so it is enough to count, whenever an
// object's state changes, with how many known or fresh ones it is paired: a line of bits an
// object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/objects/tracked_object.hpp"

namespace clearance {

class KnownPairs {
 public:
  explicit KnownPairs(const Scene& scene);

  // Takes the counts to the objects' present states; `changed` are at least those whose states are
  // not what they were.
  void update(const std::vector<TrackedObject>& objects,
              std::span<const std::uint32_t> changed) noexcept;

  // Objects that are known since the last update and were not before.
  [[nodiscard]] std::span<const std::uint32_t> regained() const noexcept { return regained_; }

  // Both objects' poses are known, as of the last update.
  [[nodiscard]] std::uint64_t known() const noexcept { return known_.pairs; }
  // Both are known and neither is late.
  [[nodiscard]] std::uint64_t fresh() const noexcept { return fresh_.pairs; }

 private:
  // The objects of one kind, and how many pairs have both objects among them.
  struct Kind {
    std::vector<std::uint64_t> members;
    std::uint64_t pairs = 0;
    [[nodiscard]] bool has(std::size_t object) const noexcept {
      return (members[object / 64] >> object % 64 & 1) != 0;
    }
  };
  // False: nothing changed.
  bool set(std::size_t object, bool is_member, Kind& kind) noexcept;

  std::size_t words_;                      // of a line
  std::vector<std::uint64_t> neighbours_;  // a line of bits an object: who makes a pair with it
  Kind known_, fresh_;
  std::vector<std::uint32_t> regained_;
};

}  // namespace clearance
