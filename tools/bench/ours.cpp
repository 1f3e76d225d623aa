#include "tools/bench/rows.hpp"

#include <fmt/format.h>

#include "core/distance.hpp"
#include "tools/bench/overlaps.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/bench/suite/solver_rival.hpp"

namespace clearance::bench {
namespace {

Answer answer_of(const DistanceResult& r) {
  return {r.distance, r.status != DistanceStatus::kIterationLimit, r.iterations, r.upper - r.lower};
}

class Ours {
 public:
  using Shape = const ConvexBody*;
  static Shape shape(const ConvexBody& body) { return &body; }

  Ours(Shape a, Shape b) : a_(*a), b_(*b) {}
  void forget() { tracking_ = {}; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    return answer_of(distance(a_, b_, world_from_a, world_from_b, tracking_));
  }

 private:
  const ConvexBody& a_;
  const ConvexBody& b_;
  TrackingState tracking_;
};

// Tracked queries that get B's place in A's frame, which was made before.
class FromRelativePoses {
 public:
  explicit FromRelativePoses(const Workload& load)
      : load_(load), states_(load.trajectories.size()) {
    for (const Trajectory& t : load.trajectories) {
      auto& poses = poses_.emplace_back();
      for (const auto& [pose_a, pose_b] : t.poses) poses.push_back(relative_pose(pose_a, pose_b));
    }
    verdict_ = judge_trajectories(load, [this](std::size_t i, const auto& use) { follow(i, use); });
  }

  void time(benchmark::State& state) {
    time_trajectories(state, load_, [this](std::size_t i, const auto& use) { follow(i, use); });
    count(state, verdict_);
  }

 private:
  template <class Use>
  void follow(std::size_t i, const Use& use) {
    const Trajectory& t = load_.trajectories[i];
    states_[i] = {};
    for (std::size_t k = 0; k < poses_[i].size(); ++k) {
      use(k, answer_of(distance(*t.a, *t.b, poses_[i][k], states_[i])));
    }
  }

  const Workload& load_;
  std::vector<std::vector<RelativePose>> poses_;  // [trajectory][step]
  std::vector<TrackingState> states_;             // [trajectory]
  Verdict verdict_;
};

void register_relative(const std::string& load) {
  const auto row = std::make_shared<std::unique_ptr<FromRelativePoses>>();
  const std::string name = fmt::format("relative/tracked/{}", load);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    if (!*row) *row = std::make_unique<FromRelativePoses>(workload(load));
    (*row)->time(state);
  });
}

}  // namespace

std::vector<Rival> clearance_rivals() {
  return {solver_rival<Ours>("Clearance", "doubles, with its certificate; tracking state", true)};
}

void register_ours(RowSet set) {
  if (set == RowSet::kThesis) {
    register_facet_balls<Ours>("");
    register_intervals<Ours>("");
    return;
  }
  register_rows<Ours>("");
  register_kind_rows<Ours>("");
  for (const std::string& load : overlap_names()) {
    register_row<Ours>(fmt::format("overlap/tracked/{}", load), load, kTracked);
    register_row<Ours>(fmt::format("overlap/cold/{}", load), load, kCold);
  }
  for (const char* load : {"f2", "f40", "boxes", "parallel-boxes", "links"})
    register_relative(load);
}

}  // namespace clearance::bench
