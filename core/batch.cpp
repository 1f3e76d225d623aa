#include "core/batch.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <optional>
#include <vector>

#include "core/batch_block.hpp"
#include "core/batch_lane.hpp"
#include "core/batch_slots.hpp"

namespace clearance {
namespace {

// Rounds between two attempts of vector code at features of which it could not tell.
constexpr std::uint32_t kRetry = 64;

// What a pair's state says without its points.
struct Features {
  explicit Features(const TrackingState& s) noexcept
      : dimension_a(s.a.dimension),
        dimension_b(s.b.dimension),
        deep(s.a.deep),
        a(s.a.feature),
        b(s.b.feature) {}
  bool operator==(const Features&) const noexcept = default;

  std::uint8_t dimension_a, dimension_b;
  bool deep;
  std::int32_t a, b;
};

}  // namespace

class DistanceBatch::Rounds {
 public:
  Rounds(std::span<const ConvexPolyhedron* const> bodies, std::span<const BodyPair> pairs)
      : of_{{bodies.begin(), bodies.end()},
            {pairs.begin(), pairs.end()},
            std::vector<TrackingState>(pairs.size())},
        slots_(of_),
        results_(pairs.size() + 1),
        failed_lanes_(slots_.blocks().size() + 1) {
    failed_.reserve(pairs.size());
    loose_.reserve(pairs.size());
    forget();
  }

  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept {
    assert(world_from_body.size() == of_.bodies.size());
    ++rounds_;
    poses_ = world_from_body;
    judge_blocks();
    single_queries_ = loose_.size() + failed_.size();
    ask_loose();
    for (const std::uint32_t pair : failed_) ask_failed(pair);
    slots_.close_holes();
    return {results_.data(), of_.pairs.size()};
  }

  void forget() noexcept {
    std::fill(of_.states.begin(), of_.states.end(), TrackingState{});
    slots_.clear();
    loose_.clear();
    for (std::uint32_t pair = 0; pair < of_.no_pair(); ++pair) loose_.push_back(pair);
  }

  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept {
    const auto index = static_cast<std::uint32_t>(pair);
    if (!slots_.has(index)) return of_.states[index].b.point;
    return last_point(slots_.block_of(index), slots_.of(index).lane, kPointB);
  }

  [[nodiscard]] std::size_t single_queries() const noexcept { return single_queries_; }

 private:
  [[nodiscard]] std::optional<FeatureKind> kind_of(std::uint32_t pair,
                                                   const TrackingState& state) const noexcept {
    return feature_kind(of_.a(pair), of_.b(pair), state);
  }

  // What failed is listed by pairs: others may move into their lanes before their turn comes.
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
    failed_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const FailedLanes& of = failed_lanes_[i];
      const BatchBlock& block = slots_.blocks()[of.block];
      for (std::uint32_t lanes = of.lanes; lanes != 0; lanes &= lanes - 1) {
        failed_.push_back(block.pair[static_cast<std::size_t>(std::countr_zero(lanes))]);
      }
    }
  }

  void ask(std::uint32_t pair) noexcept {
    const auto [a, b] = of_.pairs[pair];
    results_[pair] = distance(of_.a(pair), of_.b(pair), poses_[a], poses_[b], of_.states[pair]);
  }

  // Those that have come to features that vector code can judge are loose no longer; where it just
  // could not tell of these very features, it is asked again only now and then.
  void ask_loose() noexcept {
    std::size_t kept = 0;
    for (const std::uint32_t pair : loose_) {
      const Features before(of_.states[pair]);
      ask(pair);
      const bool stuck = before == Features(of_.states[pair]) && (rounds_ + pair) % kRetry != 0;
      const auto kind = kind_of(pair, of_.states[pair]);
      if (kind && !stuck) {
        slots_.enter(pair, *kind);
      } else {
        loose_[kept++] = pair;
      }
    }
    loose_.resize(kept);
  }

  void ask_failed(std::uint32_t pair) noexcept {
    const Features before(of_.states[pair]);
    slots_.leave(pair);
    ask(pair);
    const auto kind = kind_of(pair, of_.states[pair]);
    if (kind && before != Features(of_.states[pair])) {
      slots_.enter(pair, *kind);
    } else {
      loose_.push_back(pair);
    }
  }

  BatchPairs of_;
  BatchSlots slots_;
  std::vector<DistanceResult> results_;    // [pair], and one for lanes that are not in use
  std::vector<FailedLanes> failed_lanes_;  // of this round, at the front
  std::vector<std::uint32_t> failed_;      // pairs of this round
  std::span<const Pose> poses_;
  std::vector<std::uint32_t> loose_;  // pairs that are in no block
  std::size_t single_queries_ = 0;
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
