// Searches for parts: cuts until every piece is nearly convex, then joins pieces that fit together.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "config/decomposition/cuts.hpp"
#include "config/decomposition/open_blocks.hpp"
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
             const PartLimits& limits, CutChoice choice = CutChoice::kLeastOpen);

  // Splits pieces until the estimated error of each is at most `aim`, or there are too many. Then
  // joins pieces as long as the error stays below `aim`, or as there are more than the limits
  // allow. A call with a lower aim continues with the pieces of the call before. Returns false, and
  // joins nothing, if the search has got stuck with a piece whose error exceeds the tolerance,
  // while the other choice of cuts may get on.
  bool search(double aim);

  // Tells whether cuts that leave the least open space no longer make the worst piece better, or
  // would make too many pieces.
  [[nodiscard]] bool is_stuck() const { return is_stuck_; }

  // Joins two parts more. Returns false when one is left, or if the estimated error of every two is
  // larger than `most`, m.
  bool join_best(double most);

  // Returns the parts found. Together they hold every triangle. Returns none if coordinates are too
  // coarse for the tolerance, so that a flat piece gets no volume.
  [[nodiscard]] std::vector<ConvexBody> parts();

 private:
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
  [[nodiscard]] double joint_error(const Piece& a, const Piece& b) const;
  void estimate_joints();
  [[nodiscard]] std::vector<Vec3> points_of(const Piece& piece) const;
  [[nodiscard]] std::optional<ConvexBody> body_of_piece(const Piece& piece,
                                                        const std::vector<Vec3>& points) const;

  PartLimits limits_;
  CutChoice choice_;
  bool is_stuck_ = false;
  const OpenSpace& space_;
  std::vector<HalfSpace> faces_;  // candidates for cuts
  std::vector<OpenPoint> open_;   // in the hull of the whole
  OpenBlocks open_blocks_;        // the same points
  std::vector<Piece> pieces_;     // before joining
  std::vector<Joined> joined_;
  // Row i holds the errors of the hulls of joined piece i and each earlier one, where known.
  std::vector<std::vector<std::optional<double>>> joints_;
};

// Returns a body that holds `hull` and has far fewer facets. It exceeds the hull by a small share
// of the tolerance, or by more where it has as many facets as a part may have. Returns nothing
// where the hull itself has few enough facets.
[[nodiscard]] std::optional<ConvexBody> with_fewer_facets(ConvexBody hull, double tolerance);

}  // namespace clearance
