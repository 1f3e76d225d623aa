#include "monitor/pairs/published_pairs.hpp"

#include <algorithm>
#include <limits>

#include "config/scene/refresh_share.hpp"

namespace clearance {
namespace {

// Pairs of one vector query (about 10 us): enough to fill its lanes, few enough for the caches.
constexpr std::size_t kGroup = 256;

// A query of a pose that is NaN ends before it begins.
const Pose kNowhere{.position = Vec3::Constant(std::numeric_limits<double>::quiet_NaN())};

// Vector code takes pairs of two convex bodies.
bool is_single(std::uint32_t pair, const Scene& scene, const PairTable& table) noexcept {
  const ObjectPair& of = scene.pairs[pair];
  return table.part_pairs_of(pair) == 1 && !scene.objects[of.first].is_seen() &&
         !scene.objects[of.second].is_seen();
}

}  // namespace

PublishedPairs::PublishedPairs(const Scene& scene, const std::vector<PosedPart>& parts,
                               const PairTable& table, bool every_tick)
    : every_tick_(every_tick) {
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (!is_published(scene.pairs[p], scene)) continue;
    pairs_.push_back(p);
    part_pairs_ += table.part_pairs_of(p);
  }
  if (every_tick_) form_groups(scene, parts, table);
}

void PublishedPairs::form_groups(const Scene& scene, const std::vector<PosedPart>& parts,
                                 const PairTable& table) {
  std::vector<std::uint32_t> single;
  for (const std::uint32_t pair : pairs_) {
    (is_single(pair, scene, table) ? single : many_parts_).push_back(pair);
  }
  known_.reserve(many_parts_.size());

  constexpr std::uint32_t kUnnumbered = ~0u;
  std::vector<std::uint32_t> body_of(parts.size(), kUnnumbered);
  std::vector<const ConvexBody*> bodies;
  const auto body = [&](std::uint32_t part) {
    if (body_of[part] == kUnnumbered) {
      body_of[part] = static_cast<std::uint32_t>(bodies.size());
      bodies.push_back(parts[part].shape);
      body_parts_.push_back(part);
    }
    return body_of[part];
  };
  std::vector<BodyPair> body_pairs;
  for (const std::uint32_t pair : single) {
    const std::uint32_t part_pair = table.first_part_pair(pair);
    body_pairs.push_back({body(table.part_a(part_pair)), body(table.part_b(part_pair))});
  }
  world_from_body_.resize(bodies.size());
  for (std::size_t first = 0; first < single.size(); first += kGroup) {
    const std::size_t count = std::min(kGroup, single.size() - first);
    const auto members = std::span(single).subspan(first, count);
    groups_.push_back({{members.begin(), members.end()},
                       DistanceBatch(bodies, std::span(body_pairs).subspan(first, count)),
                       0});
  }
}

void PublishedPairs::evaluate_all(const OpenTick& tick, Budget& budget) noexcept {
  for (std::size_t i = 0; i < body_parts_.size(); ++i) {
    const PosedPart& part = tick.parts[body_parts_[i]];
    world_from_body_[i] =
        tick.objects[part.object].input.has_value ? part.world_from_part : kNowhere;
  }
  for (Group& group : groups_) {
    evaluate_group(group, tick);
    budget.spend(group.known);
  }
  known_.clear();
  for (const std::uint32_t pair : many_parts_) {
    if (is_known(pair, tick)) known_.push_back(pair);
  }
  evaluate_pairs(known_, tick, budget);
}

// Queries also the pairs that are not known. An object without a pose costs next to nothing, and a
// late one stays where it was.
void PublishedPairs::evaluate_group(Group& group, const OpenTick& tick) noexcept {
  const auto found = group.batch.evaluate(world_from_body_);
  group.known = 0;
  for (std::size_t i = 0; i < group.pairs.size(); ++i) {
    if (!is_known(group.pairs[i], tick)) continue;
    ++group.known;
    settle(group.pairs[i], found[i], group.batch.point_on_b(i), tick);
  }
}

}  // namespace clearance
