// Compares the distances of a replay with those that another program computed.
//
// A CSV table, plain or gzip: t_ns, object_a, object_b, distance (m), found by name in any order,
// times not going back. Either object may come first. If the reference is 0, the bodies touch or
// overlap, and a penetration depth of ours counts as 0. The reference is taken to be rounded to the
// digits written.
//
// A reference may be of the meshes themselves, where ours is of parts that contain them. It may
// then exceed ours by the stated errors of both objects' parts.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/replay/reference_totals.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// The largest difference of a distance from its reference where no tolerance is stated.
inline constexpr double kReferenceTolerance = 1e-6;  // m

// Judges each value twice: our distance, and our bounds. A tolerance is the largest error of the
// reference itself, and both judgements allow for it. Without a tolerance, distances may differ by
// kReferenceTolerance. Bounds then have to hold the reference up to the rounding of its digits,
// since they hold every exact distance.
class ReferenceCheck {
 public:
  // Reads the whole table; what is wrong with it is in error(). The scene must outlive this.
  // `mesh_errors`: by an object's name, the distance by which a reference may exceed ours, m
  // (CellOptions::mesh_errors); empty: the reference is of the parts.
  ReferenceCheck(const Scene& scene, const std::filesystem::path& file,
                 std::optional<double> tolerance = std::nullopt,
                 const std::map<std::string, double>& mesh_errors = {});

  [[nodiscard]] const std::string& error() const noexcept { return error_; }

  // Ticks are of another scene from now on, which outlives this.
  void change(const Scene& scene);

  // To be called for every tick, in order of time. Returns a sentence with pair and figures for the
  // first value that is off, and one for the first that is outside the bounds.
  [[nodiscard]] std::vector<std::string> check(const Report& report, const Monitor& monitor);

  // After the last tick.
  [[nodiscard]] ReferenceTotals totals() const;
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  struct Value {
    std::int64_t t_ns = 0;
    std::pair<std::string, std::string> objects;
    double distance = 0.0, rounding = 0.0;  // m
    double mesh_error = 0.0;                // m: the distance of the parts may be smaller by this
  };

  // The least distance of ours that the reference and the errors of meshes allow, m.
  [[nodiscard]] static double least_allowed(const Value& value);
  // The distance of our value from the allowed interval, m; 0 inside it.
  [[nodiscard]] static double difference_from(const Value& value, double ours);
  void compare(const Value& value, const PairReport& ours, std::vector<std::string>& broken);

  // The keys are the names of both objects, in either order.
  using PairIds = std::map<std::pair<std::string, std::string>, std::uint32_t>;
  [[nodiscard]] static PairIds pair_ids(const Scene& scene);

  const Scene* scene_;
  PairIds ids_;
  double tolerance_;         // of the distance
  double bounds_tolerance_;  // of the bounds, beside the rounding of the reference
  std::string error_;
  std::vector<Value> values_;
  std::size_t next_ = 0;
  ReferenceTotals totals_;
  std::string other_pair_;  // the first
};

}  // namespace clearance
