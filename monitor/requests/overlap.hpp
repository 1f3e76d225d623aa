// Measures the overlap and the distance of an attached object and the bodies that it may touch from
// then on.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/edit/cell_change.hpp"
#include "config/scene/scene.hpp"
#include "monitor/requests/present_poses.hpp"

namespace clearance {

// The depth by which an attached object may overlap if the change states none, m. The errors
// of both objects' parts against their meshes are added.
inline constexpr double kDefaultOverlap = 1e-3;

// An attached object that lies farther than this from its carrier and from all that it may touch is
// refused, m, unless the change says that it is far.
inline constexpr double kFarFromCarrier = 0.5;

// Returns the attachment of a change: of a robot, that of its root link. Nothing: it has none.
[[nodiscard]] std::optional<Attach> attachment_in(const CellChange& change, const Scene& scene);

// Returns the change with the pose that the object has in `scene`, to which the whole list leads.
// `later`: the changes after this one. Nothing: by one of them it is not attached there any more,
// or is attached once more.
[[nodiscard]] std::optional<Attach> as_attached(const Attach& change,
                                                std::span<const CellChange> later,
                                                const Scene& scene);

// Names of all objects that the attached one is not watched against: those that are rigidly
// connected to its carrier, and those that it may touch. Sorted.
[[nodiscard]] std::vector<std::string> left_out_with(const Attach& change, const Scene& scene);

// How an attached object lies beside what it is not watched against.
struct Fit {
  std::string deepest, nearest;  // names; empty: it overlaps none, or none has a known distance
  double depth = 0.0;            // m, of the overlap with `deepest`
  double distance = kInfinity;   // m, from `nearest`, at most; 0 if they overlap
};

// Compares an object with these. `poses` has the poses of the others and of the carrier in this
// scene, at one instant; those that are not usable are left out, except the carrier's own parts,
// which need none. A carrier without parts is its origin. `mesh_errors` has, by object, how far
// parts exceed meshes, m, and lowers the depth.
[[nodiscard]] Fit fit_of(const Attach& change, const Scene& scene,
                         const std::vector<std::string>& others, const PresentPoses& poses,
                         const std::map<std::string, double>& mesh_errors);

}  // namespace clearance
