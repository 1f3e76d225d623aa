// Searches for parts: cuts until every piece is nearly convex, then joins pieces that fit together.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "config/decomposition/open_space.hpp"
#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/piece.hpp"
#include "core/convex_body.hpp"

namespace clearance {

// The pieces follow from the cells, and not from the number of parts that is allowed, as long as
// that is at most kUsualParts. They are joined in one order. So from the same cells and with the
// same aim, more parts are an earlier stage of the search.
class PartSearch {
 public:
  // Begins with the pieces of a mesh in `cells`, which hold all of it. `space` is that of the mesh.
  PartSearch(const TriangleMesh& mesh, const OpenSpace& space, std::span<const ConvexCell> cells,
             const PartLimits& limits);

  // Splits pieces until the estimated error of each is at most `aim`, or there are too many. Then
  // joins pieces as long as the error stays below `aim`, or as there are more than the limits
  // allow. A call with a lower aim continues with the pieces of the call before.
  void search(double aim);

  // Joins two parts more. Returns false when one is left.
  bool join_two();

  // Returns the parts found. Together they hold every triangle. Returns none if coordinates are too
  // coarse for the tolerance, so that a flat piece gets no volume.
  [[nodiscard]] std::vector<ConvexBody> parts();

 private:
  // The error of the hull of two pieces: a lower bound, or the estimate itself.
  struct JointError {
    double error = 0.0;
    bool is_exact = false;
  };
  // A piece after joining, and its body once that was made.
  struct Joined {
    Piece piece;
    std::optional<ConvexBody> body = {};
    bool has_body = false;
    bool is_empty = false;  // the piece holds no triangle, and so has no body
  };

  [[nodiscard]] Piece piece_of(const ConvexCell& cell) const;
  void split(double aim);
  [[nodiscard]] std::optional<std::pair<Piece, Piece>> cut(const Piece& piece) const;
  void add_rim(const HalfSpace& plane, Piece& piece) const;
  [[nodiscard]] JointError joint_error(const Piece& a, const Piece& b, double enough) const;
  void estimate_joints(double enough);
  bool join_best(double most);
  [[nodiscard]] std::vector<Vec3> points_of(const Piece& piece) const;
  [[nodiscard]] std::optional<ConvexBody> body_of_piece(const Piece& piece,
                                                        const std::vector<Vec3>& points) const;

  PartLimits limits_;
  const OpenSpace& space_;
  std::vector<HalfSpace> faces_;  // candidates for cuts
  std::vector<OpenPoint> open_;   // in the hull of the whole
  std::vector<Piece> pieces_;     // before joining
  std::vector<Joined> joined_;
  // Row i holds the errors of joined piece i with each earlier one.
  std::vector<std::vector<JointError>> joints_;
};

// Returns a body that holds `hull` and exceeds it by a small share of the tolerance.
[[nodiscard]] ConvexBody with_fewer_facets(ConvexBody hull, double tolerance);

}  // namespace clearance
