// Times what the Python package wraps, in C++: the time of a tracked query, and that of each of
// COUNT random configurations. bench/measure.py runs it in turns with the same in Python.
//
// usage: clearance_python_loop URDF SRDF COUNT
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "config/write/single_robot_cell.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/python/module/configurations.hpp"

namespace clearance {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// s for each query; the two bodies do not move.
double time_query() {
  constexpr int kCount = 200'000;
  const auto cube = std::get<ConvexBody>(box({0.5, 0.5, 0.5}));
  const Pose pose{{2.0, 0.3, 0.4}, Eigen::Quaterniond(std::sqrt(0.86), 0.1, 0.2, 0.3)};
  const RelativePose relative = relative_pose(Pose(), pose);
  TrackingState state;
  double sum = 0.0;
  const auto begin = Clock::now();
  for (int i = 0; i < kCount; ++i) sum += distance(cube, cube, relative, state).lower;
  const double seconds = seconds_since(begin) / kCount;
  return sum > 0.0 ? seconds : -1.0;
}

// s for each configuration, into arrays as Python gets them.
double time_configurations(const Scene& scene, std::size_t count) {
  const std::size_t pairs = scene.pairs.size(), variables = scene.variables.size();
  std::mt19937_64 random(1);
  std::vector<double> joints;
  for (std::size_t i = 0; i < count; ++i) {
    for (const JointVariable& joint : scene.variables) {
      joints.push_back(std::uniform_real_distribution<double>(std::max(joint.lower, -3.14),
                                                              std::min(joint.upper, 3.14))(random));
    }
  }
  python::Configurations configurations(scene);
  const auto begin = Clock::now();
  const auto numbers = [count, pairs](std::size_t each) {
    return std::make_unique_for_overwrite<double[]>(count * pairs * each);
  };
  const auto distance = numbers(1), lower = numbers(1), upper = numbers(1);
  const auto on_a = numbers(3), on_b = numbers(3), normal = numbers(3);
  const auto status = std::make_unique_for_overwrite<std::uint8_t[]>(count * pairs);
  const auto part_a = std::make_unique_for_overwrite<std::uint32_t[]>(count * pairs);
  const auto part_b = std::make_unique_for_overwrite<std::uint32_t[]>(count * pairs);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t row = i * pairs;
    configurations.evaluate({joints.data() + i * variables, variables},
                            {.distance = &distance[row],
                             .lower = &lower[row],
                             .upper = &upper[row],
                             .status = &status[row],
                             .part_a = &part_a[row],
                             .part_b = &part_b[row],
                             .witness_a = &on_a[3 * row],
                             .witness_b = &on_b[3 * row],
                             .normal = &normal[3 * row]});
  }
  return seconds_since(begin) / static_cast<double>(count);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: clearance_python_loop URDF SRDF COUNT\n");
    return 2;
  }
  const auto cell = clearance::read_single_robot({.urdf = argv[1], .srdf = argv[2]});
  if (!std::holds_alternative<clearance::Cell>(cell)) return 3;
  const clearance::Scene& scene = std::get<clearance::Cell>(cell).scene;
  const double query = clearance::time_query();
  std::printf("%.3f %.4f\n", 1e9 * query,
              1e6 * clearance::time_configurations(scene, std::strtoull(argv[3], nullptr, 10)));
}
