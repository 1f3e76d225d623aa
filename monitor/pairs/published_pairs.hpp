// The pairs whose figures every report has, or all pairs where a scene evaluates all.
//
// They are evaluated in one straight loop in every tick whose budget covers them. Vector code takes
// many pairs of single parts at once (core/batch.hpp); the others are taken one by one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/batch.hpp"
#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {

class PublishedPairs {
 public:
  // `every_tick` is that of RefreshShare.
  PublishedPairs(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
                 bool every_tick);

  [[nodiscard]] std::span<const std::uint32_t> pairs() const noexcept { return pairs_; }
  // The largest number of queries that they take.
  [[nodiscard]] std::uint32_t part_pairs() const noexcept { return part_pairs_; }
  // All of them fit into the budget, so that they are never left to the broad phase.
  [[nodiscard]] bool every_tick() const noexcept { return every_tick_; }

  // Evaluates all that are known. The budget covers them.
  void evaluate_all(const OpenTick& tick, Budget& budget) noexcept;

 private:
  // Pairs of single parts that are evaluated together.
  struct Group {
    std::vector<std::uint32_t> pairs;
    DistanceBatch batch;
    std::uint32_t known = 0;  // how many of the pairs are known in this tick
  };
  void form_groups(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table);
  void evaluate_group(Group& group, const OpenTick& tick) noexcept;

  std::vector<std::uint32_t> pairs_;
  std::uint32_t part_pairs_ = 0;
  bool every_tick_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> body_parts_;  // the part that each body of the groups is
  std::vector<Pose> world_from_body_;      // of this tick
  // Pairs of more than one part pair, or of what a sensor sees.
  std::vector<std::uint32_t> many_parts_;
  std::vector<std::uint32_t> known_;  // those of them that are known in this tick
};

}  // namespace clearance
