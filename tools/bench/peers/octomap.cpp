// Distances of a box and an octomap by FCL.
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/distance.h>
#include <octomap/octomap.h>

#include <array>
#include <map>
#include <memory>
#include <string>

#include "tools/bench/cloud_frame.hpp"
#include "tools/bench/peers/cloud_peers.hpp"

namespace clearance::bench {
namespace {

// Without rays: the free space between is not needed for a distance.
std::shared_ptr<octomap::OcTree> tree_of_points(double resolution) {
  auto tree = std::make_shared<octomap::OcTree>(resolution);
  for (const MeasuredPoint& p : cloud_frame().points)
    tree->updateNode(octomap::point3d(p.x, p.y, p.z), true, true);
  tree->updateInnerOccupancy();
  return tree;
}

double distance_by_fcl(const fcl::CollisionObject<double>& octree, const Pose& place) {
  const Vec3 sides = 2.0 * kCloudBox;
  const fcl::CollisionObject<double> part(
      std::make_shared<fcl::Box<double>>(sides.x(), sides.y(), sides.z()),
      place.orientation.toRotationMatrix(), place.position);
  fcl::DistanceResult<double> result;
  fcl::distance(&octree, &part, fcl::DistanceRequest<double>(false, false), result);
  return result.min_distance;
}

}  // namespace

void register_octomap_clouds() {
  for (const int millimetres : {15, 25}) {
    const double resolution = 1e-3 * millimetres;
    const std::string name = "cloud/octomap-" + std::to_string(millimetres) + "mm/";
    benchmark::RegisterBenchmark((name + "build").c_str(), [resolution](benchmark::State& state) {
      for (auto _ : state) benchmark::DoNotOptimize(tree_of_points(resolution));
      state.counters["pixels"] = static_cast<double>(cloud_frame().points.size());
    })->Unit(benchmark::kMicrosecond);
    benchmark::RegisterBenchmark(
        (name + "cold").c_str(),
        [resolution](benchmark::State& state) {
          const fcl::CollisionObject<double> octree(
              std::make_shared<fcl::OcTree<double>>(tree_of_points(resolution)));
          run_cloud_peer(state, [&](const Pose& place) { return distance_by_fcl(octree, place); });
        })
        ->UseManualTime()
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace clearance::bench
