#include "core/batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <new>
#include <numeric>
#include <optional>
#include <vector>

#include "core/batch/block.hpp"
#include "core/batch/lane.hpp"
#include "core/batch/next_feature.hpp"
#include "core/batch/residence.hpp"
#include "core/batch/slots.hpp"
#include "core/query/tracked_query.hpp"

namespace clearance {
class DistanceBatch::Rounds {
 public:
  Rounds(std::span<const ConvexPolyhedron* const> bodies, std::span<const BodyPair> pairs)
      : of_{{bodies.begin(), bodies.end()},
            {pairs.begin(), pairs.end()},
            std::vector<TrackingState>(pairs.size())},
        slots_(of_),
        results_(pairs.size() + 1),
        failed_lanes_(slots_.blocks().size() + 1),
        loose_(pairs.size() / kBits + 1),
        tenures_(pairs.size()) {
    departed_.reserve(pairs.size());
    order_.reserve(pairs.size());
    forget();
  }

  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept {
    assert(world_from_body.size() == of_.bodies.size());
    ++rounds_;
    poses_ = world_from_body;
    query_ = tracked_query();
    judge_blocks();
    single_queries_ = loose_pairs_ + departed_.size();
    ask_loose();
    ask_departed();
    slots_.close_holes();
    return {results_.data(), of_.pairs.size()};
  }

  void forget() noexcept {
    std::fill(of_.states.begin(), of_.states.end(), TrackingState{});
    slots_.clear();
    std::fill(tenures_.begin(), tenures_.end(), Tenure{});
    std::fill(loose_.begin(), loose_.end(), 0);
    loose_pairs_ = 0;
    for (std::uint32_t pair = 0; pair < of_.no_pair(); ++pair) loosen(pair);
  }

  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept {
    const auto index = static_cast<std::uint32_t>(pair);
    if (!slots_.has(index)) return of_.states[index].b.point;
    return last_point(slots_.block_of(index), slots_.of(index).lane, kPointB);
  }

  [[nodiscard]] std::size_t single_queries() const noexcept { return single_queries_; }

 private:
  // A pair that has left its lane, the features that it has been walked to, by their dimensions,
  // and how far that was.
  struct Departed {
    std::uint32_t pair;
    std::uint8_t dimensions;
    WalkStart start;
  };
  static constexpr std::uint8_t kMostDimensions = 8;  // two facets

  static std::uint8_t dimensions_of(const TrackingState& s) noexcept {
    return static_cast<std::uint8_t>(3 * s.a.dimension + s.b.dimension);
  }

  static constexpr std::uint32_t kBits = 64;  // of a word of loose_

  [[nodiscard]] std::optional<FeatureKind> kind_of(std::uint32_t pair,
                                                   const TrackingState& state) const noexcept {
    return feature_kind(of_.a(pair), of_.b(pair), state);
  }

  void judge_blocks() noexcept {
    BatchRound round;
    round.blocks = slots_.blocks().data();
    round.world_from_body = poses_.data();
    round.results = results_.data();
    round.failed = failed_lanes_.data();
    for (std::size_t i = 0; i < kFeatureKinds; ++i) {
      const auto blocks = slots_.blocks_of(static_cast<FeatureKind>(i));
      round.lists[i] = {blocks.data(), blocks.size()};
    }
    const std::size_t count = run_batch(round);
    departed_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const FailedLanes& of = failed_lanes_[i];
      const BatchBlock& block = slots_.blocks()[of.block];
      for (std::uint32_t lanes = of.lanes; lanes != 0; lanes &= lanes - 1) {
        depart_lane(of, block, static_cast<std::size_t>(std::countr_zero(lanes)));
      }
    }
  }

  // All leave their lanes before any comes to a new one.
  void depart_lane(const FailedLanes& of, const BatchBlock& block, std::size_t lane) noexcept {
    const std::uint32_t pair = block.pair[lane];
    slots_.leave(pair);
    TrackingState& state = of_.states[pair];
    const WalkStart start = depart(block.kind, of_.a(pair), of_.b(pair), of, lane, state);
    departed_.push_back({pair, dimensions_of(state), start});
  }

  void ask(std::uint32_t pair, WalkStart start = {}) noexcept {
    const auto [a, b] = of_.pairs[pair];
    // In its place, not copied there.
    new (&results_[pair]) DistanceResult(
        query_(of_.a(pair), of_.b(pair), poses_[a], poses_[b], of_.states[pair], start));
  }

  // Sorted by where they are now: the processor foresees what it has just done.
  void ask_departed() noexcept {
    std::array<std::uint32_t, kMostDimensions + 2> ends{};
    for (const Departed& d : departed_) ++ends[d.dimensions + 1U];
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    order_.resize(departed_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[ends[departed_[i].dimensions]++] = i;
    for (const std::uint32_t i : order_) ask_departed(departed_[i]);
  }

  void loosen(std::uint32_t pair) noexcept {
    loose_[pair / kBits] |= std::uint64_t{1} << (pair % kBits);
    ++loose_pairs_;
  }
  void tie(std::uint32_t pair, FeatureKind kind) noexcept {
    loose_[pair / kBits] &= ~(std::uint64_t{1} << (pair % kBits));
    --loose_pairs_;
    slots_.enter(pair, kind);
  }

  // In the order of the pairs. More than one step, and the features are others, or the pair is none
  // for vector code.
  void ask_loose() noexcept {
    for (std::uint32_t word = 0; word < loose_.size(); ++word) {
      for (std::uint64_t bits = loose_[word]; bits != 0; bits &= bits - 1) {
        const auto pair = word * kBits + static_cast<std::uint32_t>(std::countr_zero(bits));
        ask(pair);
        Tenure& tenure = tenures_[pair];
        tenure.add(rounds_, results_[pair].iterations != 1);
        if (!tenure.settled(rounds_)) continue;
        if (const auto kind = kind_of(pair, of_.states[pair])) {
          tie(pair, *kind);
        } else {
          tenure.wait(Tenure::kNotAtAll);
        }
      }
    }
  }

  void ask_departed(const Departed& d) noexcept {
    const std::uint32_t pair = d.pair;
    ask(pair, d.start);
    Tenure& tenure = tenures_[pair];
    tenure.add(rounds_, true);
    const auto kind = kind_of(pair, of_.states[pair]);
    if (results_[pair].iterations == 1) {
      tenure.wait(Tenure::kRetry);
    } else if (!kind) {
      tenure.wait(Tenure::kNotAtAll);
    } else if (tenure.settled(rounds_)) {
      slots_.enter(pair, *kind);
      return;
    }
    loosen(pair);
  }

  BatchPairs of_;
  BatchSlots slots_;
  std::vector<DistanceResult> results_;    // [pair], and one for lanes that are not in use
  std::vector<FailedLanes> failed_lanes_;  // of this round, at the front
  std::vector<Departed> departed_;         // of this round
  std::vector<std::uint32_t> order_;       // of these, sorted
  std::span<const Pose> poses_;
  TrackedQuery query_ = nullptr;
  std::vector<std::uint64_t> loose_;  // a bit a pair: it is in no block
  std::vector<Tenure> tenures_;       // [pair]
  std::size_t loose_pairs_ = 0, single_queries_ = 0;
  std::uint32_t rounds_ = 0;
};

DistanceBatch::DistanceBatch(std::span<const ConvexPolyhedron* const> bodies,
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
