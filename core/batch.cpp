#include "core/batch.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>
#include <utility>
#include <vector>

#include "core/batch_block.hpp"
#include "core/batch_lane.hpp"

namespace clearance {
namespace {

// Where a pair is: block * kBlockLanes + lane, or nowhere: single queries only.
using Slot = std::uint32_t;
constexpr Slot kNowhere = ~Slot{0};

// Rounds between two attempts of vector code at features of which it could not tell.
constexpr std::uint32_t kRetry = 64;

// Lanes of each kind that may be empty.
constexpr std::size_t kMostHoles = 8;

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
      : bodies_(bodies.begin(), bodies.end()),
        pairs_(pairs.begin(), pairs.end()),
        states_(pairs.size()),
        slots_(pairs.size(), kNowhere),
        results_(pairs.size() + 1),
        blocks_((pairs.size() + kFeatureKinds * kMostHoles) / kBlockLanes + kFeatureKinds) {
    failed_.reserve(pairs.size());
    loose_.reserve(pairs.size());
    free_.reserve(blocks_.size());
    for (Settled& s : settled_) {
      s.blocks.reserve(blocks_.size());
      s.holes.reserve(kMostHoles);
    }
    forget();
  }

  std::span<const DistanceResult> evaluate(std::span<const Pose> world_from_body) noexcept {
    assert(world_from_body.size() == bodies_.size());
    ++rounds_;
    judge_blocks(world_from_body);
    list_failed();
    single_queries_ = loose_.size() + failed_.size();
    ask_loose(world_from_body);
    for (const std::uint32_t pair : failed_) ask_failed(pair, world_from_body);
    return {results_.data(), pairs_.size()};
  }

  void forget() noexcept {
    std::fill(states_.begin(), states_.end(), TrackingState{});
    std::fill(slots_.begin(), slots_.end(), kNowhere);
    for (Settled& s : settled_) {
      s.blocks.clear();
      s.holes.clear();
    }
    free_.clear();
    for (std::size_t i = blocks_.size(); i-- > 0;) free_.push_back(static_cast<std::uint32_t>(i));
    loose_.clear();
    for (std::uint32_t pair = 0; pair < no_pair(); ++pair) loose_.push_back(pair);
  }

  [[nodiscard]] Vec3 point_on_b(std::size_t pair) const noexcept {
    const Slot slot = slots_[pair];
    if (slot == kNowhere) return states_[pair].b.point;
    return last_point(blocks_[slot / kBlockLanes], slot % kBlockLanes, kPointB);
  }

  [[nodiscard]] std::size_t single_queries() const noexcept { return single_queries_; }

 private:
  // The pairs of one kind of features.
  struct Settled {
    std::vector<std::uint32_t> blocks;  // all but the last full, but for
    std::vector<Slot> holes;            // lanes that their pair has left, and some that were
  };

  [[nodiscard]] std::uint32_t no_pair() const noexcept {
    return static_cast<std::uint32_t>(pairs_.size());
  }
  [[nodiscard]] const ConvexPolyhedron& a(std::uint32_t pair) const noexcept {
    return *bodies_[pairs_[pair].a];
  }
  [[nodiscard]] const ConvexPolyhedron& b(std::uint32_t pair) const noexcept {
    return *bodies_[pairs_[pair].b];
  }
  [[nodiscard]] BatchBlock& block(Slot slot) noexcept { return blocks_[slot / kBlockLanes]; }
  [[nodiscard]] Settled& settled(FeatureKind kind) noexcept {
    return settled_[static_cast<std::size_t>(kind)];
  }

  void judge_blocks(std::span<const Pose> poses) noexcept {
    BatchRound round;
    round.blocks = blocks_.data();
    round.world_from_body = poses.data();
    round.results = results_.data();
    for (std::size_t i = 0; i < kFeatureKinds; ++i) {
      round.lists[i] = {settled_[i].blocks.data(), settled_[i].blocks.size()};
    }
    run_batch(round);
  }

  // Before any pair moves to another lane.
  void list_failed() noexcept {
    failed_.clear();
    for (const Settled& of : settled_) {
      for (const std::uint32_t index : of.blocks) {
        const BatchBlock& from = blocks_[index];
        unsigned lanes = from.failed & ((1U << from.lanes) - 1U);
        for (; lanes != 0; lanes &= lanes - 1) {
          const std::uint32_t pair = from.pair[static_cast<unsigned>(std::countr_zero(lanes))];
          if (pair != no_pair()) failed_.push_back(pair);
        }
      }
    }
  }

  void ask(std::uint32_t pair, std::span<const Pose> poses) noexcept {
    results_[pair] =
        distance(a(pair), b(pair), poses[pairs_[pair].a], poses[pairs_[pair].b], states_[pair]);
  }

  // Those that have come to features that vector code can judge are loose no longer; where it just
  // could not tell of these very features, it is asked again only now and then.
  void ask_loose(std::span<const Pose> poses) noexcept {
    std::size_t kept = 0;
    for (const std::uint32_t pair : loose_) {
      const Features before(states_[pair]);
      ask(pair, poses);
      const bool stuck = before == Features(states_[pair]) && (rounds_ + pair) % kRetry != 0;
      const auto kind = feature_kind(a(pair), b(pair), states_[pair]);
      if (kind && !stuck) {
        settle(pair, *kind);
      } else {
        loose_[kept++] = pair;
      }
    }
    loose_.resize(kept);
  }

  void ask_failed(std::uint32_t pair, std::span<const Pose> poses) noexcept {
    TrackingState& state = states_[pair];
    const Slot slot = slots_[pair];
    state.a.point = last_point(block(slot), slot % kBlockLanes, kPointA);
    state.b.point = last_point(block(slot), slot % kBlockLanes, kPointB);
    const Features before(state);
    ask(pair, poses);
    const bool stuck = before == Features(state);
    const auto kind = feature_kind(a(pair), b(pair), state);
    if (kind == block(slot).kind && !stuck) return fill(slot);
    vacate(slot);
    if (kind && !stuck) {
      settle(pair, *kind);
    } else {
      slots_[pair] = kNowhere;
      loose_.push_back(pair);
    }
  }

  void fill(Slot slot) noexcept {
    BatchBlock& to = block(slot);
    const std::uint32_t pair = to.pair[slot % kBlockLanes];
    fill_lane(to, slot % kBlockLanes, a(pair), b(pair), states_[pair]);
  }

  void place(std::uint32_t pair, Slot slot) noexcept {
    BatchBlock& to = block(slot);
    const std::size_t lane = slot % kBlockLanes;
    to.pair[lane] = pair;
    to.body_a[lane] = pairs_[pair].a;
    to.body_b[lane] = pairs_[pair].b;
    slots_[pair] = slot;
    fill(slot);
  }

  // A few holes stay, for those that come next; beyond that the last of the kind moves in.
  void vacate(Slot slot) noexcept {
    BatchBlock& from = block(slot);
    const FeatureKind kind = from.kind;
    Settled& of = settled(kind);
    from.pair[slot % kBlockLanes] = no_pair();
    if (of.holes.size() < kMostHoles) return of.holes.push_back(slot);
    while (!of.blocks.empty() && last_pair(of) == no_pair()) (void)take_last(of);
    if (is_hole(slot, kind)) place(take_last(of), slot);
  }

  void settle(std::uint32_t pair, FeatureKind kind) noexcept {
    std::vector<Slot>& holes = settled(kind).holes;
    while (!holes.empty()) {
      const Slot slot = holes.back();
      holes.pop_back();
      if (is_hole(slot, kind)) return place(pair, slot);
    }
    place(pair, append(kind));
  }

  // Still: it may have been filled or given up since.
  [[nodiscard]] bool is_hole(Slot slot, FeatureKind kind) noexcept {
    const BatchBlock& of = block(slot);
    const std::size_t lane = slot % kBlockLanes;
    return of.kind == kind && lane < of.lanes && of.pair[lane] == no_pair();
  }

  // A new lane at the end.
  Slot append(FeatureKind kind) noexcept {
    std::vector<std::uint32_t>& blocks = settled(kind).blocks;
    if (blocks.empty() || blocks_[blocks.back()].lanes == kBlockLanes) {
      open_block(blocks_[free_.back()], kind);
      blocks.push_back(free_.back());
      free_.pop_back();
    }
    BatchBlock& last = blocks_[blocks.back()];
    return blocks.back() * static_cast<Slot>(kBlockLanes) + last.lanes++;
  }

  void open_block(BatchBlock& fresh, FeatureKind kind) noexcept {
    fresh.kind = kind;
    fresh.pair.fill(no_pair());
    fresh.lanes = fresh.most_a = fresh.most_b = 0;
    fresh.plain = true;
  }

  [[nodiscard]] std::uint32_t last_pair(const Settled& of) const noexcept {
    const BatchBlock& end = blocks_[of.blocks.back()];
    return end.pair[end.lanes - 1U];
  }

  // Gives up the last lane of a kind; the pair that was in it.
  std::uint32_t take_last(Settled& of) noexcept {
    BatchBlock& end = blocks_[of.blocks.back()];
    const std::size_t lane = --end.lanes;
    const std::uint32_t pair = std::exchange(end.pair[lane], no_pair());
    if (pair != no_pair()) {
      states_[pair].a.point = last_point(end, lane, kPointA);
      states_[pair].b.point = last_point(end, lane, kPointB);
    }
    if (end.lanes == 0) {
      free_.push_back(of.blocks.back());
      of.blocks.pop_back();
    }
    return pair;
  }

  std::vector<const ConvexPolyhedron*> bodies_;
  std::vector<BodyPair> pairs_;
  std::vector<TrackingState> states_;    // points of pairs in a block are there
  std::vector<Slot> slots_;              // [pair]
  std::vector<DistanceResult> results_;  // [pair], and one for lanes that are not in use
  std::vector<BatchBlock> blocks_;
  std::array<Settled, kFeatureKinds> settled_;
  std::vector<std::uint32_t> free_;    // blocks
  std::vector<std::uint32_t> loose_;   // pairs that are in no block
  std::vector<std::uint32_t> failed_;  // pairs, of this round
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
