#include "monitor/ask/part_pairs.hpp"

#include <algorithm>
#include <tuple>

#include "config/scene/stated_errors.hpp"
#include "core/model/curved_extent.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

PartBox box_around(const ConvexBody& shape) {
  PartBox box{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  if (shape.is_curved()) {
    for (int i = 0; i < 3; ++i) {
      box.high[i] = support_value(shape.curved, Vec3::Unit(i));
      box.low[i] = -support_value(shape.curved, -Vec3::Unit(i));
    }
  }
  for (const Vec3& anchor : shape.anchors) {
    box.low = box.low.cwiseMin(anchor);
    box.high = box.high.cwiseMax(anchor);
  }
  const double more = rounded_up(shape.radius + shape.position_error +
                                 0x1p-46 * (shape.bounding_radius + shape.radius));
  box.low.array() -= more;
  box.high.array() += more;
  for (const Ray& ray : shape.rays) {
    for (int i = 0; i < 3; ++i) {
      // A rounded direction may hide a small component.
      const bool along = !ray.exact || ray.direction[i] != 0.0;
      if (along && (ray.direction[i] >= 0.0 || ray.is_line || !ray.exact)) box.high[i] = kInfinity;
      if (along && (ray.direction[i] <= 0.0 || ray.is_line || !ray.exact)) box.low[i] = -kInfinity;
    }
  }
  return box;
}

// The objects of a pair that zones limit by their distance from the other one.
struct Limited {
  bool first = false, second = false;
};

// By Scene::pairs.
std::vector<Limited> limited_objects(const Scene& scene) {
  std::vector<Limited> limited(scene.pairs.size());
  for (const Zone& zone : scene.zones) {
    for (std::size_t i = 0; zone.separation && i < zone.pairs.size(); ++i) {
      Limited& of = limited[zone.pairs[i]];
      (zone.separation->human_is_first[i] != 0 ? of.second : of.first) = true;
    }
  }
  return limited;
}

// A pair of objects, directed: the tip is a link that moves relative to the base. Of two links, it
// is the one that a zone limits.
struct Directed {
  std::uint32_t base, tip;
  bool swapped, base_is_link, base_carries_tip;

  // Pairs that are not of one kind have a chain of their own.
  [[nodiscard]] bool is_of_a_kind() const noexcept { return !base_is_link && !base_carries_tip; }
};

}  // namespace

PartPairs::PartPairs(const Scene& scene, Posture& posture) {
  for (const PosedPart& part : posture.parts()) boxes_.push_back(box_around(*part.shape));
  Chains& chains = posture.chains();
  std::vector<Directed> directed;
  const std::vector<Limited> limited = limited_objects(scene);
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) {
    std::uint32_t base = scene.pairs[p].first, tip = scene.pairs[p].second;
    const bool first_is_tip = limited[p].first || (!limited[p].second && !chains.can_move(tip));
    const bool swapped = !chains.is_link(tip) || (chains.is_link(base) && first_is_tip);
    if (swapped) std::swap(base, tip);
    if (!chains.is_link(tip)) continue;
    directed.push_back({.base = base,
                        .tip = tip,
                        .swapped = swapped,
                        .base_is_link = chains.is_link(base),
                        .base_carries_tip = chains.carrier_of(tip) == base});
  }
  const auto key = [](const Directed& d) {
    return std::tuple(d.tip, !d.is_of_a_kind(), d.is_of_a_kind() ? 0 : d.base, d.base);
  };
  std::sort(directed.begin(), directed.end(),
            [&](const Directed& a, const Directed& b) { return key(a) < key(b); });

  const StatedErrors errors(scene);
  const auto first = posture.first_part();
  const auto same = [](const Directed& a, const Directed& b) {
    return a.tip == b.tip && a.is_of_a_kind() == b.is_of_a_kind() &&
           (a.is_of_a_kind() || a.base == b.base);
  };
  for (std::size_t from = 0, to = 0; from < directed.size(); from = to) {
    while (to < directed.size() && same(directed[from], directed[to])) ++to;
    const Directed& any = directed[from];
    const Chain chain = chains.between(any.base, any.tip);
    double model_error = 0.0;
    for (std::size_t i = from; i < to; ++i)
      model_error = std::max(model_error, errors.largest(directed[i].base, any.tip));
    for (std::uint32_t tip = first[any.tip]; tip < first[any.tip + 1]; ++tip) {
      const PosedPart& part = posture.parts()[tip];
      Bundle bundle{.tip = tip,
                    .object_tip = any.tip,
                    .object_base = any.base,
                    .base_is_link = any.base_is_link,
                    .base_carries_tip = any.base_carries_tip,
                    .keeps_direction = part.keeps_direction && part.shape->bounded(),
                    .chain = chain,
                    .sum_of_reaches = chains.sum_of_reaches(chain),
                    .model_error = model_error,
                    .first = static_cast<std::uint32_t>(pairs_.size())};
      for (std::size_t i = from; i < to; ++i) {
        for (std::uint32_t base = first[directed[i].base]; base < first[directed[i].base + 1];
             ++base) {
          PartPair pair{.base = base,
                        .bundle = static_cast<std::uint32_t>(bundles_.size()),
                        .swapped = directed[i].swapped};
          if (posture.is_seen(directed[i].base)) {
            pair.seen = static_cast<std::uint32_t>(seen_.size());
            seen_.emplace_back();
          }
          pairs_.push_back(pair);
        }
      }
      bundle.end = static_cast<std::uint32_t>(pairs_.size());
      if (bundle.end > bundle.first) bundles_.push_back(bundle);
    }
  }
  chains.finish();
  tracking_.resize(pairs_.size());
  tracked_in_.resize(pairs_.size(), 0);
}

}  // namespace clearance
