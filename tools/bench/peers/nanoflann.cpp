// Distances of a box and points by nanoflann.
#include <nanoflann.hpp>

#include <cmath>
#include <memory>
#include <vector>

#include "tools/bench/cloud_frame.hpp"
#include "tools/bench/peers/cloud_peers.hpp"

namespace clearance::bench {
namespace {

struct Points {
  const std::vector<MeasuredPoint>& of;

  [[nodiscard]] std::size_t kdtree_get_point_count() const { return of.size(); }
  [[nodiscard]] float kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return axis == 0 ? of[i].x : axis == 1 ? of[i].y : of[i].z;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                 Points, 3, std::uint32_t>;

struct Cloud {
  Points points{cloud_frame().points};
  Tree tree{3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10)};

  double nearest(const Vec3& at) const {
    const float query[3] = {static_cast<float>(at.x()), static_cast<float>(at.y()),
                            static_cast<float>(at.z())};
    std::uint32_t index = 0;
    float squared = 0.0F;
    tree.knnSearch(query, 1, &index, &squared);
    return std::sqrt(double{squared});
  }
};

// The signed distance of a point and the box at the origin, negative inside.
double box_distance(const Vec3& p) {
  const Vec3 outside = p.cwiseAbs() - kCloudBox;
  return outside.cwiseMax(0.0).norm() + std::min(0.0, outside.maxCoeff());
}

// The nearest point of the box's centre bounds its distance from the box. No point outside of the
// ball with that distance and the box's radius is nearer.
double exact(const Cloud& cloud, const Pose& place) {
  const Vec3& centre = place.position;
  const double reach = cloud.nearest(centre) + kCloudBox.norm();
  const float query[3] = {static_cast<float>(centre.x()), static_cast<float>(centre.y()),
                          static_cast<float>(centre.z())};
  std::vector<std::pair<std::uint32_t, float>> found;
  cloud.tree.radiusSearch(query, static_cast<float>(reach * reach * 1.0001), found,
                          nanoflann::SearchParams(32, 0.0F, false));
  double least = 1e9;
  for (const auto& [index, squared] : found) {
    const MeasuredPoint& p = cloud.points.of[index];
    least = std::min(least,
                     box_distance(place.orientation.conjugate() * (Vec3(p.x, p.y, p.z) - centre)));
  }
  return least;
}

double by_spheres(const Cloud& cloud, const Pose& place) {
  const double radius = (kCloudBox / 3.0).norm();
  double least = 1e9;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        const Vec3 centre = kCloudBox.cwiseProduct(Vec3(x, y, z)) * (2.0 / 3.0);
        least =
            std::min(least, cloud.nearest(place.orientation * centre + place.position) - radius);
      }
    }
  }
  return least;
}

}  // namespace

void register_nanoflann_clouds() {
  const auto add = [](const char* name, auto run) {
    return benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMicrosecond);
  };
  add("cloud/nanoflann/build", [](benchmark::State& state) {
    for (auto _ : state) {
      const Cloud cloud;
      benchmark::DoNotOptimize(cloud.tree.root_node);
    }
    state.counters["pixels"] = static_cast<double>(cloud_frame().points.size());
  });
  const auto cloud = [] {
    static const Cloud made;
    return &made;
  };
  add("cloud/nanoflann/cold", [cloud](benchmark::State& state) {
    run_cloud_peer(state, [&](const Pose& place) { return exact(*cloud(), place); });
  })->UseManualTime();
  add("cloud/nanoflann-spheres/cold", [cloud](benchmark::State& state) {
    run_cloud_peer(state, [&](const Pose& place) { return by_spheres(*cloud(), place); });
  })->UseManualTime();
}

}  // namespace clearance::bench
