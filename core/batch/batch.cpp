#include "core/batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <new>
#include <numeric>
#include <vector>

#include "core/batch/block.hpp"
#include "core/batch/lane.hpp"
#include "core/batch/next_feature.hpp"
#include "core/batch/residence.hpp"
#include "core/batch/slots.hpp"
#include "core/distance.hpp"
#include "core/query/entries.hpp"

namespace clearance {
// A round judges all blocks. Pairs whose lanes failed leave their blocks. These, and the pairs in
// no block, are queried one by one; a pair that keeps its features long enough enters a block. The
// constructor takes all memory: a round allocates nothing.
class DistanceBatch::Rounds {
 public:
  Rounds(std::span<const ConvexBody* const> bodies, std::span<const BodyPair> pairs)
      : of_{{bodies.begin(), bodies.end()},
            {pairs.begin(), pairs.end()},
            std::vector<TrackingState>(pairs.size())},
        slots_(of_),
        results_(pairs.size() + 1),
        failed_lanes_(slots_.blocks().size() + 1),
        unassigned_(pairs.size() / kBits + 1),
        residences_(pairs.size()) {
    queried_.reserve(pairs.size());
    for (const BodyPair& pair : pairs) {
      queried_.push_back({bodies[pair.a], bodies[pair.b], pair.a, pair.b});
    }
    changed_.reserve(pairs.size());
    order_.reserve(pairs.size());
    forget();
  }

  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept {
    assert(world_from_body.size() == of_.bodies.size());
    ++rounds_;
    poses_ = world_from_body;
    entries_ = &query_entries();
    changed_.clear();
    if (resting_ > 0) {
      --resting_;
      query_all();
      return {results_.data(), of_.pairs.size()};
    }
    if (slots_.pairs() > 0) {
      dissolve_small_blocks();
      judge_blocks();
    }
    single_queries_ = unassigned_pairs_ + changed_.size();
    waiting_before_ = waiting_;
    waiting_.fill(0);
    query_unassigned();
    if (!changed_.empty()) {
      query_changed();
      slots_.close_holes();
    }
    if (slots_.pairs() == 0 && !any_will_enter()) resting_ = kRestingRounds;
    return {results_.data(), of_.pairs.size()};
  }

  void forget() noexcept {
    std::fill(of_.states.begin(), of_.states.end(), TrackingState{});
    slots_.clear();
    std::fill(residences_.begin(), residences_.end(), Residence{});
    std::fill(unassigned_.begin(), unassigned_.end(), 0);
    unassigned_pairs_ = 0;
    waiting_.fill(0);
    resting_ = 0;
    for (std::uint32_t pair = 0; pair < of_.no_pair(); ++pair) unassign(pair);
  }

  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept {
    const auto index = static_cast<std::uint32_t>(pair);
    if (!slots_.has(index)) return of_.states[index].b.point;
    return last_point(slots_.block_of(index), slots_.of(index).lane, kPointB);
  }

  [[nodiscard]] std::size_t single_queries() const noexcept { return single_queries_; }

 private:
  // A pair that has left its lane, the features to which it has been moved, and the transitions to
  // them.
  struct Changed {
    std::uint32_t pair;
    FeaturePair features;
    TransitionsMade start;
  };

  // A single query of a pair reads this first.
  struct Queried {
    const ConvexBody *a, *b;
    std::uint32_t pose_a, pose_b;
  };

  static constexpr std::uint32_t kBits = 64;  // of a word of unassigned_
  // Pairs of the same features for which vectors are faster than single queries.
  static constexpr std::uint32_t kLeastPairs = 4;
  static constexpr std::uint32_t kRestingRounds = 15;

  // Returns a bool and not an optional of the features. The optional would be stored in two parts
  // and loaded as one: the failed store forwarding takes up to 6 % of a batch's time.
  [[nodiscard]] bool fits_lane(std::uint32_t pair) const noexcept {
    return clearance::fits_lane(of_.a(pair), of_.b(pair), of_.states[pair]);
  }

  // A vector takes as long for one pair as for all of its lanes.
  [[nodiscard]] bool are_enough(FeaturePair features) const noexcept {
    return slots_.pairs_of(features) + waiting_before_[static_cast<std::size_t>(features)] >=
           kLeastPairs;
  }
  // Waits until there are enough pairs with the same features. Whether the pair fits a lane is
  // examined only then, because it takes longer.
  [[nodiscard]] bool waits(std::uint32_t pair) noexcept {
    const TrackingState& state = of_.states[pair];
    if (state.a.kind > FeatureKind::kFacet || state.b.kind > FeatureKind::kFacet) return false;
    const FeaturePair features = feature_pair(state);
    if (are_enough(features)) return false;
    ++waiting_[static_cast<std::size_t>(features)];
    return true;
  }
  void dissolve_small_blocks() noexcept {
    for (std::size_t i = 0; i < kFeaturePairs; ++i) {
      const auto features = static_cast<FeaturePair>(i);
      const std::uint32_t pairs = slots_.pairs_of(features);
      if (pairs == 0 || pairs >= kLeastPairs - 1) continue;
      for (const std::uint32_t index : slots_.blocks_of(features)) {
        const BatchBlock& block = slots_.blocks()[index];
        for (std::uint32_t lanes = block.taken; lanes != 0; lanes &= lanes - 1) {
          const std::uint32_t pair = block.pair[static_cast<std::size_t>(std::countr_zero(lanes))];
          slots_.leave(pair);
          unassign(pair);
        }
      }
    }
  }

  // Failed lanes come back as bits: pairs leave in the order of blocks and lanes, which does not
  // depend on the width of the vectors.
  void judge_blocks() noexcept {
    BatchRound round;
    round.blocks = slots_.blocks().data();
    round.world_from_body = poses_.data();
    round.results = results_.data();
    round.failed = failed_lanes_.data();
    for (std::size_t i = 0; i < kFeaturePairs; ++i) {
      const auto blocks = slots_.blocks_of(static_cast<FeaturePair>(i));
      round.lists[i] = {blocks.data(), blocks.size()};
    }
    const std::size_t count = run_batch(round);
    for (std::size_t i = 0; i < count; ++i) {
      const FailedLanes& of = failed_lanes_[i];
      const BatchBlock& block = slots_.blocks()[of.block];
      for (std::uint32_t lanes = of.lanes; lanes != 0; lanes &= lanes - 1) {
        leave_lane(of, block, static_cast<std::size_t>(std::countr_zero(lanes)));
      }
    }
  }

  // All pairs leave their lanes before any of them enters a new one.
  void leave_lane(const FailedLanes& of, const BatchBlock& block, std::size_t lane) noexcept {
    const std::uint32_t pair = block.pair[lane];
    slots_.leave(pair);
    TrackingState& state = of_.states[pair];
    const TransitionsMade start =
        to_next_feature(block.features, of_.a(pair), of_.b(pair), of, lane, state);
    changed_.push_back({pair, feature_pair(state), start});
  }

  // The results are made in their places, not copied there.
  void query(std::uint32_t pair) noexcept {
    const Queried& q = queried_[pair];
    TrackingState& state = of_.states[pair];
    new (&results_[pair]) DistanceResult(entries_->by_poses[entry_of(*q.a, *q.b, state)](
        *q.a, *q.b, poses_[q.pose_a], poses_[q.pose_b], state));
  }
  void query_after(std::uint32_t pair, TransitionsMade start) noexcept {
    const Queried& q = queried_[pair];
    new (&results_[pair]) DistanceResult(entries_->after_transitions(
        *q.a, *q.b, poses_[q.pose_a], poses_[q.pose_b], of_.states[pair], start));
  }

  // The pairs are sorted by their features, because the processor predicts branches that it has
  // just taken.
  void query_changed() noexcept {
    std::array<std::uint32_t, kFeaturePairs + 1> ends{};
    for (const Changed& c : changed_) ++ends[static_cast<std::size_t>(c.features) + 1U];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    order_.resize(changed_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      order_[ends[static_cast<std::size_t>(changed_[i].features)]++] = i;
    }
    for (const std::uint32_t i : order_) query_changed(changed_[i]);
  }

  void unassign(std::uint32_t pair) noexcept {
    unassigned_[pair / kBits] |= std::uint64_t{1} << (pair % kBits);
    ++unassigned_pairs_;
  }
  void assign(std::uint32_t pair) noexcept {
    unassigned_[pair / kBits] &= ~(std::uint64_t{1} << (pair % kBits));
    --unassigned_pairs_;
    slots_.enter(pair);
  }

  // A body without a pose would cost more than a tracked one in every round. The last result still
  // holds.
  [[nodiscard]] bool is_still_nowhere(std::uint32_t pair) const noexcept {
    if (results_[pair].status != DistanceStatus::kBadPose) return false;
    const auto [a, b] = of_.pairs[pair];
    return std::isnan(poses_[a].position.x()) || std::isnan(poses_[b].position.x());
  }

  // While no features are those of enough pairs, most rounds do nothing but queries.
  void query_all() noexcept {
    for (std::uint32_t pair = 0; pair < of_.no_pair(); ++pair) {
      if (!is_still_nowhere(pair)) query(pair);
    }
    single_queries_ = of_.no_pair();
  }
  [[nodiscard]] bool any_will_enter() const noexcept {
    return std::any_of(waiting_.begin(), waiting_.end(),
                       [](std::uint32_t pairs) { return pairs >= kLeastPairs; });
  }

  // Queries the unassigned pairs one by one, in order. More than one transition counts as a change:
  // the pair has other features, or vector code cannot answer it.
  void query_unassigned() noexcept {
    for (std::uint32_t word = 0; word < unassigned_.size(); ++word) {
      for (std::uint64_t bits = unassigned_[word]; bits != 0; bits &= bits - 1) {
        const auto pair = word * kBits + static_cast<std::uint32_t>(std::countr_zero(bits));
        if (is_still_nowhere(pair)) continue;
        query(pair);
        Residence& residence = residences_[pair];
        residence.add(rounds_, results_[pair].iterations != 1);
        if (!residence.settled(rounds_) || waits(pair)) continue;
        if (fits_lane(pair)) {
          assign(pair);
        } else {
          residence.wait(Residence::kNotAtAll);
        }
      }
    }
  }

  void query_changed(const Changed& of) noexcept {
    const std::uint32_t pair = of.pair;
    query_after(pair, of.start);
    Residence& residence = residences_[pair];
    residence.add(rounds_, true);
    // The lane named no neighbour and the query ended at the same features: lanes cannot certify
    // this pair, so it stays outside for a while.
    if (results_[pair].iterations == 1) {
      residence.wait(Residence::kRetry);
    } else if (!fits_lane(pair)) {
      residence.wait(Residence::kNotAtAll);
    } else if (residence.settled(rounds_) && !waits(pair)) {
      slots_.enter(pair);
      return;
    }
    unassign(pair);
  }

  BatchPairs of_;
  BatchSlots slots_;
  std::vector<DistanceResult> results_;    // [pair], and one for lanes that are not in use
  std::vector<FailedLanes> failed_lanes_;  // of this round, at the front
  std::vector<Changed> changed_;           // of this round
  std::vector<std::uint32_t> order_;       // of these, sorted
  std::span<const Pose> poses_;
  std::vector<std::uint64_t> unassigned_;  // a bit a pair: it is in no block
  std::vector<Residence> residences_;      // [pair]
  std::vector<Queried> queried_;           // [pair]
  const QueryEntries* entries_ = nullptr;  // of this round
  // [features]: the unassigned pairs that would enter a lane, in this round and in the last one
  std::array<std::uint32_t, kFeaturePairs> waiting_{}, waiting_before_{};
  std::size_t unassigned_pairs_ = 0, single_queries_ = 0;
  std::uint32_t rounds_ = 0, resting_ = 0;
};

DistanceBatch::DistanceBatch(std::span<const ConvexBody* const> bodies,
                             std::span<const BodyPair> pairs)
    : rounds_(std::make_unique<Rounds>(bodies, pairs)) {}
DistanceBatch::~DistanceBatch() = default;
DistanceBatch::DistanceBatch(DistanceBatch&&) noexcept = default;
DistanceBatch& DistanceBatch::operator=(DistanceBatch&&) noexcept = default;

std::span<const DistanceResult> DistanceBatch::evaluate(
    std::span<const Pose> world_from_body) noexcept {
  return rounds_->evaluate(world_from_body);
}

Vec3 DistanceBatch::point_on_b(std::size_t pair) const noexcept {
  return rounds_->point_on_b(pair);
}

void DistanceBatch::forget() noexcept { rounds_->forget(); }

std::size_t DistanceBatch::single_queries() const noexcept { return rounds_->single_queries(); }

const char* DistanceBatch::instruction_set() noexcept { return batch_instruction_set(); }

}  // namespace clearance
