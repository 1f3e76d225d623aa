// The points of an organised cloud as balls that contain the surface between them.
//
// A point has the points of the eight pixels around it as neighbours, if they lie on one surface
// with it. Its ball reaches the middle between it and each of them, and the middle of each cell of
// up to four neighbours. To that comes the largest error of those points. So the balls contain the
// surface that is bilinear between the true points of neighbours:
//
// A point s of it is the sum of w_k P'_k over the corners of a cell, with the true points P'_k.
// Around corner i, |s - P_i| <= |sum w_k (P_k - P_i)| + sum w_k e_k. The first term is convex in
// each parameter of the cell, so it is largest in the middle of an edge or of the cell. The second
// one is at most the largest e_k.
//
// All corners of a plane's cell are neighbours if its incidence t is nowhere above 80 degrees, and
// tan t <= kWidestNeighbour / (the distance of the rays across the diagonal at a range of 1).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/clouds/point_cloud.hpp"
#include "monitor/intake/camera_messages.hpp"

namespace clearance {

// Two points are on one surface if the ranges differ, beyond both errors, by at most this times the
// distance of the rays at the nearer one: an incidence of 80 degrees.
inline constexpr double kSteepest = 6.0;
// Ranges differ by at most this times the nearer range, too. The rays of a cell are at most as far
// apart at a range of 1. Sensor::extent() rests on both.
inline constexpr double kWidestNeighbour = 0.1;

class OrganisedPoints {
 public:
  // `points` come row by row, in the frame of the sensor; missing ones are NaN. Their radii bound
  // their errors, and are replaced. Each is at least half of the diagonal between the widest rays
  // of the frame, so that a point without neighbours contains what its pixel sees. A point whose
  // radius is NaN shows its ray only, and is missing afterwards. Any other result than kNoFault
  // leaves the points as they are: kNotOrganised, kWideRays or kUnknownRays.
  [[nodiscard]] FrameFault widen(std::uint32_t width, std::uint32_t height,
                                 std::span<MeasuredPoint> points);

 private:
  struct Ray {
    Vec3 point = Vec3::Zero(), direction = Vec3::Zero();
    double range = 0.0, error = 0.0;  // m; range 0: missing; error NaN: only a ray
  };
  struct Reach {
    double squared = 0.0;  // m2
    double error = 0.0;    // m
  };
  // The corners of a cell by their places in the message.
  void add_cell(const std::array<const Ray*, 4>& rays, const std::array<Reach*, 4>& reaches);
  [[nodiscard]] static bool on_one_surface(const Ray& a, const Ray& b, double chord2) noexcept;

  std::vector<Ray> rows_;  // two
  std::vector<Reach> reaches_;
  // The squared distances of neighbouring rays at a range of 1: in a row, in a column, and across
  // the diagonal.
  std::array<double, 3> widest2_{};
};

}  // namespace clearance
