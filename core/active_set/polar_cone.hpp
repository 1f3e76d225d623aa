// The directions along which neither of two unbounded bodies goes on for ever, seen from the other:
// the polar cone of all rays of A and all reversed rays of B. Only they bound a distance or a
// depth.
//
// Where a ray stands across such a direction n, the cone has its rim there, and the last digits of
// n decide whether it is inside: n must be moved onto it. In the plane across n each ray that is
// level to rounding leaves a half-plane for the end of the move, and the nearest point that all of
// them have in common is where one or two of them are exactly level. All in twice double precision,
// as are the rays and the rotation between the bodies: it costs a direction no more than the
// rounding of its own doubles, at whatever angle the rays cross. Of rays that are parallel but for
// an angle that only the quaternions' own digits say, one is put in the other's place: the way in
// which it leans (core/model/lean.hpp).
#pragma once

#include <array>
#include <optional>

#include "core/active_set/certificate.hpp"
#include "core/model/lean.hpp"
#include "core/model/wide_rotation.hpp"

namespace clearance {

class PolarCone {
 public:
  PolarCone(const ActiveFeature& a, const ActiveFeature& b) noexcept;

  // A unit vector, common frame, and how far from it (an angle) there certainly is a direction of
  // the cone; infinity: none is known nearby.
  struct Direction {
    Vec3 n;
    double off;
  };
  [[nodiscard]] Direction nearest(const Separator& s) const noexcept;

  // The direction across two edges without end, one of A and one of B: the exact one is no farther
  // off than that; infinity: not known.
  [[nodiscard]] Direction across_lines(const Edge& of_a, const Edge& of_b) const noexcept;

  // A facet's exact normal, outward.
  [[nodiscard]] Direction of_facet(bool of_b, std::int32_t facet) const noexcept;
  // How an edge without end of the other body rises over the facet, per metre, off by no more than
  // `error` and 4 roundings; infinity: not known.
  struct Slope {
    double rate, error;
  };
  [[nodiscard]] Slope slope_over_facet(bool of_b, std::int32_t facet,
                                       const Edge& edge) const noexcept;

  // Where each body has one line and these cross for certain, the cone has no other directions than
  // this and its opposite; infinity: not known.
  [[nodiscard]] Direction only_direction() const noexcept;
  // How any ray but lines rises along n and along all that is no farther off: they all fall, one
  // rises, or neither for certain.
  enum class Rise { kFall, kUnknown, kRise };
  [[nodiscard]] Rise rise_of_others(const Direction& n) const noexcept;

  // Calls take(Separator) with the directions across a ray of each body where these are so nearly
  // parallel that the bodies' features do not say them. Which directions of all those across such a
  // ray the cone has does not change with the angle, but with where it opens: half of them or, of
  // two lines, two.
  template <class Take>
  void across_near_parallels(const Take& take) const noexcept {
    if (a_.body().rays.size() * b_.body().rays.size() > kMostPairs) return;
    for (const Ray& of_b : b_.body().rays) {
      const Vec3 g = narrow(of_ray(of_b, true));
      for (const Ray& of_a : a_.body().rays) {
        if (!(of_a.direction.cross(g).norm() < kNearlyParallel)) continue;
        const Direction d = across(of_a, of_b);
        if (!(d.off < kInfinity)) continue;
        take(Separator{d.n});
        take(Separator{Vec3(-d.n)});
      }
    }
  }

 private:
  static constexpr double kParallel = 0x1p-90, kNearlyParallel = 0x1p-18;
  static constexpr std::size_t kMostPairs = 0x1p16;

  // n.g <= 0 for all directions n of the cone, g being a ray. Along n + x t + y u it rises by
  // at_n + x along_t + y along_u.
  struct Constraint {
    WideVec g;
    const Ray* ray;
    bool of_b;
    bool known;  // g is exactly three doubles
    // Held exactly level: its opposite is another one, or all but is.
    bool two_way = false;
    double slope;  // at_n, in a double
    DoubleDouble at_n, along_t, along_u;
  };
  // Two of these that lean apart: the second one is a multiple of the first and the way; seen from
  // the second, the first one is one and `back` times the way.
  struct Leaning {
    std::size_t first, second;
    double back;
    bool parallel;
    DoubleDouble at_n, along_t, along_u;
  };
  static constexpr std::size_t kMostLeaning = 64;
  // Of the rays that are level to rounding. Of more, nothing is known.
  struct Level {
    std::array<Constraint, 64> items;
    std::size_t size = 0;
    std::array<Leaning, kMostLeaning> leaning;
    std::size_t leaning_size = 0;
    Vec3 n, t, u;
  };
  struct Move {
    double x = 0.0, y = 0.0;
    double error = 0.0;
    double length2 = kInfinity;
  };

  [[nodiscard]] WideVec of_ray(const Ray& ray, bool of_b) const noexcept;
  [[nodiscard]] Direction across(const Ray& of_a, const Ray& of_b) const noexcept;
  [[nodiscard]] bool collect(const ConvexPolyhedron& body, bool of_b, const Vec3& n,
                             Level& level) const noexcept;
  [[nodiscard]] bool opposite(const Constraint& c, const Constraint& d) const noexcept;
  [[nodiscard]] bool same_line(const Constraint& c, const Constraint& d) const noexcept;
  void prepare(const Vec3& n, Level& level) const noexcept;
  void find_leaning(Level& level) const noexcept;
  [[nodiscard]] static const Leaning* leaning(const Level& level, std::size_t i,
                                              std::size_t k) noexcept;
  [[nodiscard]] bool falls_from(const Level& level, std::size_t i, std::size_t k,
                                const DoubleDouble& x, const DoubleDouble& y,
                                double error) const noexcept;
  [[nodiscard]] const Lean& lean() const noexcept;
  [[nodiscard]] LongVec<7> exactly(const Constraint& c) const noexcept;
  [[nodiscard]] bool falls_across(const Level& level, std::size_t i, std::size_t j,
                                  std::size_t k) const noexcept;
  [[nodiscard]] bool holds_as_it_is(const Separator& s, const Vec3& n,
                                    const Level& level) const noexcept;
  void try_move(const Level& level, std::size_t i, std::size_t j, const DoubleDouble& x,
                const DoubleDouble& y, double error, Move& best) const noexcept;
  [[nodiscard]] Move shortest_move(const Level& level) const noexcept;

  const ActiveFeature& a_;
  const ActiveFeature& b_;
  WideRotation rotation_;
  mutable std::optional<Lean> lean_;  // made where it is needed
  double error_;                      // of a constraint's numbers
};

}  // namespace clearance
