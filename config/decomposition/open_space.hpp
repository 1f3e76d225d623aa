// The space around a mesh, sampled on a grid. It has the distance of each grid point from the mesh,
// and says which points a ball from outside can get to. It is approximate: it guides the search for
// parts, and certifies nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"

namespace clearance {

// A point of the open space.
struct OpenPoint {
  Vec3 position;
  double distance;  // from the mesh, m
};

class OpenSpace {
 public:
  // A point is open if a ball of radius `ball` can move to it from outside without touching the
  // mesh.
  OpenSpace(const TriangleMesh& mesh, double ball);

  [[nodiscard]] double spacing() const { return spacing_; }
  // Returns the open points of the grid at least this far from the mesh.
  [[nodiscard]] std::vector<OpenPoint> points(double least) const;
  // Tells whether no such ball can get to this point. The point may be outside the grid, and is
  // then open.
  [[nodiscard]] bool encloses(const Vec3& point) const;

 private:
  using Index = Eigen::Array3i;

  [[nodiscard]] std::size_t flat(const Index& at) const {
    return (static_cast<std::size_t>(at.z()) * static_cast<std::size_t>(count_.y()) +
            static_cast<std::size_t>(at.y())) *
               static_cast<std::size_t>(count_.x()) +
           static_cast<std::size_t>(at.x());
  }
  [[nodiscard]] Vec3 centre(const Index& at) const {
    return origin_ + spacing_ * at.cast<double>().matrix();
  }
  [[nodiscard]] Index index_of(const Vec3& point) const {
    return ((point - origin_) / spacing_).array().round().cast<int>();
  }
  template <class Visit>
  void each(const Visit& visit) const;

  void sample(const TriangleMesh& mesh);
  void offer(const Index& at, std::int32_t sample);
  void spread();
  void flood(double ball);
  bool spread_open(const Index& at, double least, std::vector<Index>& reached);

  Vec3 origin_;
  double spacing_ = 0.0;
  Index count_;
  std::vector<Vec3> samples_;          // points of the mesh
  std::vector<std::int32_t> nearest_;  // index of the sample nearest to each cell's centre
  std::vector<float> distance_;        // from that sample, m
  std::vector<bool> open_;
};

}  // namespace clearance
