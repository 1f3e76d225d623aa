// A recorded run in short stretches of time, for the time line and for the plots before any moment.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "tools/view/stretches.hpp"

namespace clearance::view {

class RunHistory {
 public:
  static constexpr std::size_t kMostPoints = 600;  // points of a curve: more than its pixels

  // The least minimum of a stretch of time; NaN when no minimum was known.
  struct Piece {
    std::int64_t begin_ns = 0;  // log time of the stretch's first report
    std::int64_t time_ns = 0;   // log time of the least minimum; without one, `begin_ns`
    double distance = std::numeric_limits<double>::quiet_NaN();  // m
    double lower = distance;
    double tick_us = distance;  // the longest time from the begin of a tick to its report
    double scaling = distance;  // the least speed scaling of all zones; NaN when there was none
  };

  // The least distance of a published pair, m, and its greatest closing speed, m/s; NaN when they
  // were not known.
  struct Extremes {
    float distance = std::numeric_limits<float>::quiet_NaN();
    float closing_speed = distance;
  };

  RunHistory();

  // The reports that follow are of this scene. A pair of the same objects goes on.
  void change_scene(const Scene& scene);
  // Takes reports in the order of their log times.
  void take(const clearance_msg_Distances& report, std::int64_t log_ns);
  void take(const clearance_msg_Separation& separation, std::int64_t log_ns);
  void take(const clearance_msg_Health& health, std::int64_t log_ns);

  // The least of the whole run; NaN when there is none.
  [[nodiscard]] Piece least() const;
  // The run in at most `most` stretches of equal length, without those that have no report.
  [[nodiscard]] std::vector<Piece> pieces(std::size_t most) const;
  // The last `width_ns` up to `end_ns`, as JSON: {"s": [...], "distance": [...], "lower": [...],
  // "tick": [...], "scaling": [...], "pairs": {"ID": [...]}, "speeds": {"ID": [...]}, "residuals":
  // {"CAMERA: LINK": [[s, m], ...]}}. Units are s after the first report, m, us and m/s. null: not
  // known. Residuals are the medians of the links that are seen farthest from their places. The
  // pairs are those of `scene`, also where another scene was in force; values of pairs that are not
  // published are null.
  [[nodiscard]] std::string window(std::int64_t end_ns, std::int64_t width_ns, const Scene& scene,
                                   std::span<const std::uint32_t> pairs) const;

 private:
  using Names = std::pair<std::string, std::string>;  // of two objects, in ascending order
  [[nodiscard]] static Names names_of(const Scene& scene, const ObjectPair& pair);
  // Extremes of the stretches from `first` up to, but not including, `last`; not known, if the pair
  // was not published.
  [[nodiscard]] Extremes extremes_of(std::uint32_t column, std::size_t first,
                                     std::size_t last) const;

  // The JSON of the residuals from one log time, exclusive, to another one.
  [[nodiscard]] nlohmann::json residuals(std::int64_t from_ns, std::int64_t to_ns) const;

  static constexpr std::size_t kMostResiduals = 6;  // curves
  static constexpr std::uint32_t kNotPublished = std::numeric_limits<std::uint32_t>::max();
  std::map<Names, std::uint32_t> columns_;
  std::vector<std::uint32_t> column_of_;  // by pair of the present scene
  Stretches<Piece, Extremes> run_;        // a column per pair that any scene publishes
  // Log time and median, by the names of a camera and a link.
  std::map<std::string, std::vector<std::pair<std::int64_t, double>>> medians_;
};

// Join two neighbouring stretches of time, or a pair's values in them; Stretches calls these.
void merge(const RunHistory::Piece& later, RunHistory::Piece& into);
void merge(const RunHistory::Extremes& later, RunHistory::Extremes& into);

}  // namespace clearance::view
