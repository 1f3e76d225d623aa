// Several bodies in one frame, for tests that enclose them in models.
#pragma once

#include <algorithm>
#include <vector>

#include "core/enclosing_polyhedron.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance::test {

// Bodies in one frame, as the core's models and as the exact oracle's bodies.
struct Group {
  std::vector<oracle::Body> bodies;
  std::vector<ConvexBody> shapes;
  std::vector<PlacedShape> placed;

  void add(const oracle::Body& body, const Pose& pose) {
    bodies.push_back(body);
    shapes.push_back(made(body));
    placed.push_back({nullptr, pose});
    for (std::size_t i = 0; i < shapes.size(); ++i) placed[i].shape = &shapes[i];
  }

  [[nodiscard]] double exact_distance_from(const Vec3& position) const {
    const oracle::Body probe{.rows = {}, .points = {position}};
    double nearest = kInfinity;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      nearest = std::min(
          nearest,
          oracle::exact_distance(probe, Pose{}, bodies[i], placed[i].frame_from_shape).lower);
    }
    return nearest;
  }
};

inline Group random_group(Random& random, int count) {
  Group group;
  for (int i = 0; i < count; ++i) {
    const oracle::Body body =
        random.chance(0.3) ? hard::rounded(random) : hard::any_bounded(random);
    group.add(body, {random.in_box(2.0),
                     random.chance(0.3) ? Eigen::Quaterniond::Identity() : random.rotation()});
  }
  return group;
}

inline Group boxes_apart(double gap) {
  Group group;
  const oracle::Body box = hard::box({0.5, 0.5, 0.5});
  group.add(box, {});
  group.add(box, {.position = Vec3(1.0 + gap, 0.0, 0.0)});
  return group;
}

}  // namespace clearance::test
