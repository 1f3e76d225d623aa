// The numbers of pairs that are absent, known or stale, counted without visiting pairs.
//
// The state of a pair follows from its two objects. So when an object's state changes, it is enough
// to count its partners in each state. Each object has a row of bits for that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/tracked_object.hpp"

namespace clearance {

class KnownPairs {
 public:
  explicit KnownPairs(const Scene& scene);

  // Takes the counts to the objects' states of this tick. `changed`: at least the objects whose
  // states are not what they were.
  void update(std::span<const TrackedObject> objects,
              std::span<const std::uint32_t> changed) noexcept;

  // Objects that are known as of the last update and were not before it.
  [[nodiscard]] std::span<const std::uint32_t> regained() const noexcept { return regained_; }

  // After the last update: no object is absent; ...
  [[nodiscard]] std::uint64_t present() const noexcept { return present_.pairs; }
  // ... both objects' poses are known; ...
  [[nodiscard]] std::uint64_t known() const noexcept { return known_.pairs; }
  // ... both are known and neither is late.
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

  std::size_t words_;                      // in a row of `neighbours_`
  std::vector<std::uint64_t> neighbours_;  // one row of bits per object: its partners in pairs
  Kind present_, known_, fresh_;
  std::vector<std::uint32_t> regained_;
};

}  // namespace clearance
