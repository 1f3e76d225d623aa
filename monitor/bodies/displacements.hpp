// Stage 2 of a tick: how far each object has moved since the last tick, and bounds over all
// objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/bodies/ingest.hpp"

namespace clearance {

struct Displacements {
  // Objects whose pose, lateness or bound of unobserved motion differs from the last tick. In the
  // first tick of a monitor these are all objects.
  std::vector<std::uint32_t> changed;
  bool any_lost = false;  // an object is not known, or has made a discontinuity
  // Bounds for any two known objects together, m. `most_unobserved` (U) bounds their unobserved
  // motion. `most_displaced` bounds how far they were, at any instant since the last tick, from
  // where they are now.
  double most_unobserved = 0.0, most_displaced = 0.0;
  // Newest and oldest stamp of the moving objects' poses in use; 0: none is in use.
  std::int64_t newest_pose_ns = 0, oldest_pose_ns = 0;
  bool response_is_late = false;  // of an object, as InputRecord says
};

// The stage. It visits the objects that VisitTimes says are due, and keeps what the summary needs
// of all others.
class Displacer {
 public:
  explicit Displacer(const Scene& scene);

  // Advances the objects that are not fixed to this tick; their `bounding_radius` must be set.
  void displace(Inputs& inputs) noexcept;
  [[nodiscard]] const Displacements& result() const noexcept { return displaced_; }
  // True until the first displace().
  [[nodiscard]] bool is_first() const noexcept { return first_; }
  // Adds an object to `changed`.
  void add_changed(std::uint32_t object) noexcept { displaced_.changed.push_back(object); }

 private:
  void visit(std::uint32_t i, bool first, Inputs& inputs, Trust trust = Trust::kAlways) noexcept;
  void visit_seen(bool first, Inputs& inputs) noexcept;
  void summarise(Inputs& inputs) noexcept;

  const Scene& scene_;
  Displacements displaced_;
  std::vector<std::uint32_t> seen_;     // objects of sensors, ascending
  std::vector<std::uint32_t> visited_;  // in this tick
  std::vector<bool> is_lost_;           // by object: not known, or discontinuous
  std::size_t lost_ = 0;                // number of such objects
  bool first_ = true;
};

}  // namespace clearance
