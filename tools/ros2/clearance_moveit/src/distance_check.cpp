#include "distance_check.hpp"

#include "moveit_log.hpp"

#include <algorithm>
#include <limits>

namespace clearance_moveit {

namespace types = collision_detection::DistanceRequestTypes;

// Returns the pairs whose boxes are close enough to count.
std::vector<DistanceCheck::Candidate> DistanceCheck::candidates(const PosedParts& a,
                                                                const PosedParts& b) const {
  const double within =
      is_global() ? result_.minimum_distance.distance : request_.distance_threshold;
  std::vector<Candidate> all;
  all.reserve(a.parts.size() * b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    for (std::size_t j = &a == &b ? i + 1 : 0; j < b.parts.size(); ++j) {
      if (&a == &b && a.parts[i].owner == b.parts[j].owner) continue;
      // If the boxes overlap, they do not bound how deep the bodies do.
      const double between = gap(a.boxes[i], b.boxes[j]);
      const double apart = between > 0.0 ? between : -std::numeric_limits<double>::infinity();
      if (apart < within) all.push_back({apart, i, j});
    }
  }
  return all;
}

void DistanceCheck::check(const PosedParts& a, const PosedParts& b, PairFilter& filter) {
  std::vector<Candidate> left = candidates(a, b);
  if (!is_global()) {
    for (const Candidate& of : left) {
      if (is_done()) return;
      measure(a, b, of, filter);
    }
    return;
  }
  const auto later = [](const Candidate& x, const Candidate& y) {
    return std::tie(x.gap, x.i, x.j) > std::tie(y.gap, y.i, y.j);
  };
  std::ranges::make_heap(left, later);
  while (!left.empty() && !is_done()) {
    std::ranges::pop_heap(left, later);
    if (!(left.back().gap < result_.minimum_distance.distance)) return;
    measure(a, b, left.back(), filter);
    left.pop_back();
  }
}

double DistanceCheck::limit(const Pair& pair) const {
  if (is_global()) return result_.minimum_distance.distance;
  const auto known = result_.distances.find(pair);
  if (known == result_.distances.end() || known->second.empty()) return request_.distance_threshold;
  switch (request_.type) {
    case types::LIMITED:
      return known->second.size() < request_.max_contacts_per_body ? request_.distance_threshold
                                                                   : known->second.back().distance;
    case types::SINGLE:
      return known->second.front().distance;
    default:
      return request_.distance_threshold;
  }
}

void DistanceCheck::measure(const PosedParts& a, const PosedParts& b, const Candidate& of,
                            PairFilter& filter) {
  const PosedPart &part_a = a.parts[of.i], &part_b = b.parts[of.j];
  if (filter.decide(part_a.owner, part_b.owner) == PairFilter::Decision::kLeftOut) return;
  const Owner &owner_a = a.owners[part_a.owner], &owner_b = b.owners[part_b.owner];
  Pair pair(owner_a.name, owner_b.name);
  if (pair.second < pair.first) std::swap(pair.first, pair.second);
  const double least = limit(pair);
  if (!(of.gap < least)) return;
  double within = std::max(0.0, least);  // a leaf that is deeper is at no distance, too
  const Depth depth = request_.enable_signed_distance ? Depth::kAsked : Depth::kNotAsked;
  collision_detection::DistanceResultsData nearest;
  nearest.distance = least;
  query_parts(part_a, a.boxes[of.i], part_b, b.boxes[of.j], within, depth, [&](const Found& found) {
    if (!(found.distance < nearest.distance)) return true;
    within = std::max(0.0, found.distance);
    nearest.distance = found.distance;
    nearest.nearest_points[0] = found.point_a;
    nearest.nearest_points[1] = found.point_b;
    nearest.normal = found.normal;
    return depth == Depth::kAsked || !found.collides;
  });
  if (!(nearest.distance < least)) return;
  nearest.link_names[0] = owner_a.name;
  nearest.link_names[1] = owner_b.name;
  nearest.body_types[0] = owner_a.type;
  nearest.body_types[1] = owner_b.type;
  if (request_.verbose) {
    RCLCPP_INFO(logger(), "'%s' and '%s': %.9g m", owner_a.name.c_str(), owner_b.name.c_str(),
                nearest.distance);
  }
  take(nearest, pair);
}

void DistanceCheck::take(const collision_detection::DistanceResultsData& found, const Pair& pair) {
  if (found.distance < result_.minimum_distance.distance) result_.minimum_distance = found;
  if (found.distance <= 0.0) result_.collision = true;
  if (is_global()) return;
  auto& kept = result_.distances[pair];
  const auto at = std::ranges::upper_bound(kept, found.distance, {},
                                           &collision_detection::DistanceResultsData::distance);
  kept.insert(at, found);
  const std::size_t most = request_.type == types::SINGLE    ? 1
                           : request_.type == types::LIMITED ? request_.max_contacts_per_body
                                                             : kept.size();
  if (kept.size() > most) kept.resize(most);
}

}  // namespace clearance_moveit
