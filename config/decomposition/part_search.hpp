// Searches for parts: cuts until every piece is nearly convex, then joins pieces that fit together.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "config/decomposition/open_space.hpp"
#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/piece.hpp"
#include "core/convex_body.hpp"

namespace clearance {

class PartSearch {
 public:
  PartSearch(const TriangleMesh& mesh, const PartLimits& limits);

  // Returns parts whose estimated error is at most `aim`, or as many parts as the limits allow.
  // Together they hold every triangle. A call with a lower aim continues with the pieces of the
  // call before.
  std::vector<ConvexBody> parts(double aim);

 private:
  [[nodiscard]] Piece whole() const;
  void split(double aim);
  [[nodiscard]] std::optional<std::pair<Piece, Piece>> cut(const Piece& piece) const;
  void add_rim(const HalfSpace& plane, Piece& piece) const;
  [[nodiscard]] double joint_error(const Piece& a, const Piece& b, double enough) const;
  void join(double aim, std::vector<Piece>& pieces) const;
  [[nodiscard]] std::vector<Vec3> points_of(const Piece& piece) const;

  const TriangleMesh& mesh_;
  PartLimits limits_;
  OpenSpace space_;
  Eigen::AlignedBox3d box_;
  std::vector<HalfSpace> faces_;  // candidates for cuts
  std::vector<OpenPoint> open_;   // in the hull of the whole
  std::vector<Piece> pieces_;     // before joining
};

// Returns a body that holds `hull` and exceeds it by a small share of the tolerance.
[[nodiscard]] ConvexBody with_fewer_facets(ConvexBody hull, double tolerance);

}  // namespace clearance
