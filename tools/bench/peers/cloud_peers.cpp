#include "tools/bench/peers/cloud_peers.hpp"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/cloud_frame.hpp"

namespace clearance::bench {
namespace {

constexpr std::size_t kPlaces = 200;

// The certified distance of the nearest point at each place.
const std::vector<double>& truth() {
  static const std::vector<double> made = [] {
    PointCloud cloud(cloud_frame().points.size());
    static_cast<void>(cloud.build(cloud_frame().points, {{0, 0, 2}, 10.0}));
    const ConvexBody part = std::get<ConvexBody>(box(kCloudBox));
    CloudTracking tracking;
    std::vector<double> out;
    for (const Pose& place : cloud_places(kPlaces)) {
      tracking.forget();
      const NearestElement found = nearest_element(part, cloud, relative_pose(place, {}), tracking);
      out.push_back(0.5 * (found.lower + found.upper) + double{kBallRadius});
    }
    return out;
  }();
  return made;
}

}  // namespace

void run_cloud_peer(benchmark::State& state, const std::function<double(const Pose&)>& distance) {
  const std::vector<Pose> places = cloud_places(kPlaces);
  double largest = 0.0, sum = 0.0;
  std::size_t i = 0, asked = 0;
  for (auto _ : state) {
    const double begin = cpu_ns();
    const double found = distance(places[i]);
    state.SetIterationTime(1e-9 * (cpu_ns() - begin));
    // In contact, peers say only that it is one.
    const double error = std::max(0.0, found) - std::max(0.0, truth()[i]);
    if (std::abs(error) > std::abs(largest)) largest = error;
    sum += std::abs(error);
    ++asked;
    i = (i + 1) % places.size();
  }
  state.counters["max_error"] = largest;
  state.counters["mean_error"] = sum / static_cast<double>(asked);
}

}  // namespace clearance::bench
