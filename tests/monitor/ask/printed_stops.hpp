// Random stops of an arm as its cell states them, with tables of several categories, loads and
// extensions, and how the true machine stops.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "config/scene/scene.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// By step of the extension; one if it is not measured. Speeds ascend.
using PrintedRows = std::vector<std::vector<StopPoint>>;

// How a joint of the true machine stops: by the rows that are printed for its load and extension,
// with straight lines between them. Without rows it stops as slowly as the cell states.
class MachineStop {
 public:
  // `stated`: by step of the extension.
  MachineStop(std::vector<JointStop> stated, PrintedRows rows)
      : stated_(std::move(stated)), rows_(std::move(rows)) {}

  [[nodiscard]] double distance(double speed, std::size_t step = 0) const {
    if (rows_.empty()) return stated_.at(step).distance(speed);
    const std::vector<StopPoint>& rows = rows_.at(step);
    const double share = speed / (speed < rows.front().speed ? rows.front() : rows.back()).speed;
    if (share < 1.0) return between(rows, speed, &StopPoint::distance, share);
    return share * share * rows.back().distance;
  }
  [[nodiscard]] double time(double speed, std::size_t step = 0) const {
    if (!(speed > 0.0)) return 0.0;
    if (rows_.empty()) return stated_.at(step).time(speed);
    const std::vector<StopPoint>& rows = rows_.at(step);
    const double share = speed / rows.back().speed;
    return share < 1.0 ? between(rows, speed, &StopPoint::time, 1.0) : share * rows.back().time;
  }

 private:
  // `below`: the share of the first row's value that a lower speed has.
  [[nodiscard]] static double between(const std::vector<StopPoint>& rows, double speed,
                                      double StopPoint::*value, double below) {
    if (speed <= rows.front().speed) return below * rows.front().*value;
    const auto next = std::ranges::lower_bound(rows, speed, {}, &StopPoint::speed);
    const StopPoint &from = *(next - 1), &to = *next;
    return std::lerp(from.*value, to.*value, (speed - from.speed) / (to.speed - from.speed));
  }

  std::vector<JointStop> stated_;
  PrintedRows rows_;  // empty: none is printed
};

// The key `stopping` of an arm of config/cells/seven_joint_arm.
class PrintedStops {
 public:
  // `measures`: the cell may state how load and extension follow from masses and postures.
  PrintedStops(double reaction, Random& random, bool measures) : random_(random) {
    const bool keeps_path = random.chance(0.5);
    const int category = keeps_path ? 1 : random.integer(0, 1);
    // A stated load counts with the next printed step and all lower ones.
    const int load = random.integer(2, 100), extension = random.integer(2, 100);
    const bool has_load = random.chance(0.6), has_extension = random.chance(0.6);
    admitted_ = {has_load ? (load + 49) / 50 : 2, has_extension ? (extension + 49) / 50 : 2};
    const bool weighs = measures && random.chance(0.5);
    if (measures && random.chance(0.7)) reach_ = random.uniform(0.5, 1.3);
    for (int i = 1; i <= 7; ++i) add("joint" + std::to_string(i), i < 5 ? 2.2 : 2.6, category);
    add("finger", 0.2, category);
    text_ =
        fmt::format("{{reaction_ms: {}, category: {}, path: {}{}{}{}, joints: {{{}}}}}",
                    1e3 * reaction, category, keeps_path ? "kept" : "left",
                    !has_load || table_.empty() ? ""
                    : weighs ? fmt::format(", load: {{full: 7, tool: {}}}", 0.07 * load)
                             : fmt::format(", load: {}", load),
                    table_.empty()  ? ""
                    : reach_ > 0.0  ? fmt::format(", extension: {{link: hand, reach: {}}}", reach_)
                    : has_extension ? fmt::format(", extension: {}", extension)
                                    : "",
                    table_.empty() ? "" : fmt::format(", table: [{}]", table_), joints_);
  }

  [[nodiscard]] const std::string& text() const { return text_; }
  // Of the joints that move, in their order; empty: no table states it.
  [[nodiscard]] const std::vector<PrintedRows>& rows() const { return rows_; }
  // Up to half of it, the first step of the extension counts, m; 0: it is not measured.
  [[nodiscard]] double reach() const { return table_.empty() ? 0.0 : reach_; }

 private:
  void add(const std::string& joint, double full, int category) {
    rows_.emplace_back();
    const double kind = random_.uniform(0.0, 3.0);
    if (kind < 1.0) {
      say(joint, fmt::format("deceleration: {:.4f}", random_.uniform(1.0, 20.0) * full));
    } else if (kind < 2.0) {
      say(joint, fmt::format("time_ms: {}", random_.integer(10, 300)));
    } else {
      print(joint, full, category);
    }
  }
  void say(const std::string& joint, const std::string& stop) {
    joints_ += fmt::format("{}{}: {{{}}}", joints_.empty() ? "" : ", ", joint, stop);
  }
  // Rows are not monotone. The machine has one of the admitted loads and extensions.
  void print(const std::string& joint, double full, int stated_category) {
    const bool slides = joint == "finger";
    const int load = random_.integer(1, admitted_.first),
              extension = random_.integer(1, admitted_.second);
    const bool is_by_rows = random_.chance(0.5);
    const int speeds = random_.integer(1, 3);
    for (const int category : {0, 1}) {
      for (int l = 1; l <= 2; ++l) {
        for (int e = 1; e <= 2; ++e) {
          for (int s = 1; s <= speeds; ++s) {
            const int percent = 100 * s / speeds, ms = random_.integer(50, 400);
            const double speed = 0.01 * percent * full;
            const double unit = slides ? 1e-3 : std::numbers::pi / 180.0;  // mm, degrees
            const double most = speed * 1e-3 * ms / unit;
            const double went = std::floor(1e4 * most * random_.uniform(0.1, 1.0)) * 1e-4;
            table_ += fmt::format(
                "{}{{joint: {}, category: {}, load_percent: {}, extension_percent: {}, "
                "speed_percent: {}, time_ms: {}, {}: {:.4f}}}",
                table_.empty() ? "" : ", ", joint, category, 50 * l, 50 * e, percent, ms,
                slides ? "distance_mm" : "angle_deg", went);
            if (!is_by_rows || category != stated_category || l != load) continue;
            if (reach_ > 0.0 || e == extension)
              of_step(e).push_back({speed, went * unit, 1e-3 * ms});
          }
        }
      }
    }
  }

  std::vector<StopPoint>& of_step(int extension) {
    PrintedRows& rows = rows_.back();
    const std::size_t step = reach_ > 0.0 ? static_cast<std::size_t>(extension - 1) : 0;
    if (rows.size() <= step) rows.resize(step + 1);
    return rows[step];
  }

  Random& random_;
  double reach_ = 0.0;
  std::pair<int, int> admitted_;  // steps of load and extension
  std::string table_, joints_, text_;
  std::vector<PrintedRows> rows_;
};

}  // namespace clearance::test
