#include "monitor/tick/known_queries.hpp"

#include <utility>
#include <variant>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "monitor/inputs/checksum.hpp"

namespace clearance {
namespace {

// The shapes below are valid.
ConvexBody made(ShapeResult shape) { return std::get<ConvexBody>(std::move(shape)); }

// An orientation in which no axis of one body is parallel to one of the other.
Pose placed(const Vec3& position) {
  return {position, Eigen::Quaterniond(6.0 / 9.0, 2.0 / 9.0, 4.0 / 9.0, 5.0 / 9.0)};
}

std::vector<KnownQuery> make_queries() {
  const ConvexBody cube = made(box({0.5, 0.25, 0.75}));
  const ConvexBody tetrahedron = made(polyhedron_from_vertices(
      std::array{Vec3(0, 0, 0), Vec3(0.6, 0, 0), Vec3(0.1, 0.7, 0), Vec3(0.2, 0.1, 0.8)}));
  const ConvexBody capsule = made(segment({0, 0, -0.4}, {0, 0, 0.4}, 0.1));
  std::vector<KnownQuery> all;
  all.push_back({"two boxes apart", cube, cube, placed({1.75, 0.5, 0.25}), 0});
  all.push_back({"a box and a tetrahedron apart", cube, tetrahedron, placed({-1.5, 0.75, 1.0}), 0});
  all.push_back(
      {"a capsule and a tetrahedron apart", capsule, tetrahedron, placed({0.25, -1.25, 0.5}), 0});
  all.push_back(
      {"a box and a tetrahedron that overlap", cube, tetrahedron, placed({0.25, 0.125, -0.25}), 0});
  all.push_back({"a cylinder and a box apart", made(cylinder(0.25, 0.5)), cube,
                 placed({0.5, 1.5, -0.75}), 0});
  return all;
}

// Of the results of the queries above, in their order. KnownQueries.* prints others.
constexpr std::array<std::uint64_t, 5> kAnswers{0x0fe958bfbaa793e5, 0x64939a0f06378f93,
                                                0xa4dc442951eb9217, 0x22f1ac5931344e46,
                                                0x236fab1fe6adc7be};

}  // namespace

std::uint64_t KnownQuery::ask() const noexcept {
  TrackingState state;
  const DistanceResult result = distance(a, b, Pose{}, a_from_b, state);
  Checksum sum;
  for (const double value : {result.distance, result.lower, result.upper}) sum.add(value);
  for (const Vec3& vector : {result.normal, result.point_on_a, result.point_on_b}) sum.add3(vector);
  sum.add(result.status);
  sum.add(result.path);
  sum.add(result.iterations);
  return sum.value();
}

std::span<const KnownQuery> known_queries() {
  static const std::vector<KnownQuery> all = [] {
    std::vector<KnownQuery> queries = make_queries();
    for (std::size_t i = 0; i < queries.size(); ++i) queries[i].answer = kAnswers[i];
    return queries;
  }();
  return all;
}

}  // namespace clearance
