#include "monitor/pairs/hull_bound.hpp"

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// A hull is given in its object's frame, so it is placed without rounding.
PosedPart around(const ConvexBody& hull) {
  PosedPart placed;
  placed.shape = &hull;
  placed.extent = rounded_up(hull.bounding_radius + hull.position_error);
  return placed;
}

}  // namespace

HullBound::HullBound(const Scene& scene, const std::vector<PosedPart>& parts,
                     const KnownHulls& known)
    : hulls_(bounding_hulls(scene, known)),
      placed_(scene.objects.size()),
      only_part_(scene.objects.size(), kNoModel) {
  for (std::size_t i = 0; i < hulls_.size(); ++i) {
    if (hulls_[i]) placed_[i] = around(*hulls_[i]);
  }
  for (std::uint32_t part = 0; part < parts.size(); ++part) {
    const std::uint32_t object = parts[part].object;
    if (scene.objects[object].parts.size() == 1) only_part_[object] = part;
  }
}

bool HullBound::possible(const PairEntry& pair) const noexcept {
  const auto has_hull = [this](std::uint32_t object) { return hulls_[object] != nullptr; };
  const auto has_model = [&](std::uint32_t object) {
    return has_hull(object) || only_part_[object] != kNoModel;
  };
  return has_model(pair.object_a) && has_model(pair.object_b) &&
         (has_hull(pair.object_a) || has_hull(pair.object_b));
}

double HullBound::lower(std::uint32_t pair, const TickView& view, Budget& budget) noexcept {
  const PosedPart& a = model(view.pairs.entries[pair].object_a, view);
  const PosedPart& b = model(view.pairs.entries[pair].object_b, view);
  TrackingState cold;
  budget.spend();
  const DistanceResult found =
      distance(*a.shape, *b.shape, relative_pose(a.world_from_part, b.world_from_part), cold,
               {.depth = false});
  const double model_error = view.pairs.largest_error(view.pairs.first_part_pair(pair));
  return rounded_down(found.lower - rounded_up(placing_error(a, b) + model_error));
}

const PosedPart& HullBound::model(std::uint32_t object, const TickView& view) noexcept {
  if (hulls_[object] == nullptr) return view.parts[only_part_[object]];
  placed_[object].world_from_part = view.objects[object].pose;
  return placed_[object];
}

}  // namespace clearance
