#include "tools/bench/rows.hpp"

#include <fmt/format.h>

#include "core/distance.hpp"
#include "tools/bench/overlaps.hpp"
#include "tools/bench/solver_rows.hpp"
#include "tools/bench/suite/rivals.hpp"
#include "tools/bench/suite/solver_rival.hpp"

namespace clearance::bench {
namespace {

class Ours {
 public:
  using Shape = const ConvexBody*;
  static Shape shape(const ConvexBody& body) { return &body; }

  Ours(Shape a, Shape b) : a_(*a), b_(*b) {}
  void forget() { tracking_ = {}; }
  Answer query(const Pose& world_from_a, const Pose& world_from_b) {
    const DistanceResult r = distance(a_, b_, world_from_a, world_from_b, tracking_);
    return {r.distance, r.status != DistanceStatus::kIterationLimit, r.iterations,
            r.upper - r.lower};
  }

 private:
  const ConvexBody& a_;
  const ConvexBody& b_;
  TrackingState tracking_;
};

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
}

}  // namespace clearance::bench
