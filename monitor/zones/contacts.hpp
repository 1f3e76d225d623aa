// Contact that is meant: the allowances of the scene from tick to tick, one entry for each pair.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene_map.hpp"
#include "monitor/inputs/state_bytes.hpp"
#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {

class Contacts {
 public:
  // The scene must outlive it.
  explicit Contacts(const Scene& scene);

  // Before the first tick: an allowance that the scene before had as well goes on, or has ended, as
  // there. Does not allocate.
  void take_over(const Contacts& before, const SceneMap& map) noexcept;
  // The same through bytes, for the same scene.
  void save(StateWriter& out) const;
  void restore(StateReader& in, std::int64_t now_ns) noexcept;

  // Stage 'allow' of a tick: ends the allowances whose end has come. Those that are in force now
  // are so for the time since the last tick.
  void begin_tick(std::uint64_t cycle, std::int64_t now_ns) noexcept;

  // The least distance that an allowance in force permits this pair, m. +infinity: none is.
  [[nodiscard]] double least_allowed(std::uint32_t pair) const noexcept {
    return entries_.empty() ? kInfinity : least_allowed_of(pair);
  }

  // Stage 'judge', one entry after another: takes in the bounds of this tick.
  [[nodiscard]] std::uint32_t pair(std::size_t entry) const noexcept {
    return reports_[entry].pair;
  }
  void judge(std::size_t entry, const PairBounds& bounds, const TickView& view) noexcept;

  // After judge(): the pair's contact is as allowed, so that no zone counts it as near.
  [[nodiscard]] bool allow(std::uint32_t pair) const noexcept {
    return any_allowed_ && is_allowed(pair);
  }
  // After judge(): the entry of this pair; nullptr: no contact is allowed for it.
  [[nodiscard]] const ContactReport* find(std::uint32_t pair) const noexcept {
    return entries_.empty() ? nullptr : find_entry(pair);
  }

  // The reports stand in ascending order of pairs.
  [[nodiscard]] std::span<const ContactReport> reports() const noexcept { return reports_; }

 private:
  struct Entry {
    double least_allowed;  // m: minus the depth
    ContactEnd end;
    std::int64_t last_ns = ContactEnd::kNoTime;  // the time of the end, once it is in force
    bool was_far = false;  // certified in a tick to be at the distance that ends it
  };
  [[nodiscard]] double least_allowed_of(std::uint32_t pair) const noexcept;
  [[nodiscard]] bool is_allowed(std::uint32_t pair) const noexcept;
  [[nodiscard]] const ContactReport* find_entry(std::uint32_t pair) const noexcept;

  std::vector<Entry> entries_;
  std::vector<ContactReport> reports_;  // one for each entry
  bool any_allowed_ = false;            // in this tick
};

}  // namespace clearance
