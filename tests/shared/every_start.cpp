#include "tests/shared/every_start.hpp"

#include <algorithm>
#include <vector>

namespace clearance::test {
namespace {

// Each feature of the body with a point on it, and the state without a feature.
std::vector<TrackingState::Side> every_side(const ConvexBody& body) {
  std::vector<TrackingState::Side> out(1);
  const auto add = [&](FeatureKind kind, std::size_t feature, const Vec3& point) {
    out.push_back({kind, false, static_cast<std::int32_t>(feature), point});
  };
  for (std::size_t i = 0; i < body.vertices.size(); ++i)
    add(FeatureKind::kVertex, i, body.vertices[i].position);
  for (std::size_t i = 0; i < body.edges.size(); ++i) {
    const Edge& edge = body.edges[i];
    add(FeatureKind::kEdge, i, edge.point + std::min(0.5 * edge.end, 1.0) * edge.direction);
  }
  for (std::size_t i = 0; i < body.facets.size(); ++i)
    add(FeatureKind::kFacet, i, body.point_of(body.facets[i]));
  return out;
}

std::string name_of(const TrackingState::Side& side) {
  return std::to_string(static_cast<int>(side.kind)) + '/' + std::to_string(side.feature);
}

}  // namespace

std::string fault_from_any_start(DistanceJudge& judge, const Pose& pose_a, const Pose& pose_b) {
  const oracle::ExactDistance truth = judge.truth(pose_a, pose_b);
  for (const TrackingState::Side& side_a : every_side(judge.a())) {
    for (const TrackingState::Side& side_b : every_side(judge.b())) {
      for (const bool touched : {false, true}) {
        TrackingState state{side_a, side_b};
        state.a.penetrating = touched;
        const DistanceResult result = judge.ask(pose_a, pose_b, state);
        std::string out;
        for (const std::string& fault : judge.faults(result, truth, pose_a, pose_b)) {
          out += "\n  " + fault;
        }
        if (out.empty()) continue;
        return "from " + name_of(side_a) + " and " + name_of(side_b) +
               (touched ? ", touching:" : ":") + out;
      }
    }
  }
  return {};
}

}  // namespace clearance::test
