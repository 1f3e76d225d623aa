// Reads the whole table of reference distances, then compares value by value as the ticks pass
// their times. Differences are judged with the rounding of the digits written.
#include "monitor/replay/reference_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "monitor/files/table.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/replay/metres.hpp"

namespace clearance {
namespace {

constexpr std::array<std::string_view, 4> kColumns = {"t_ns", "object_a", "object_b", "distance"};
// Places in kColumns.
enum Column : std::size_t { kTime, kObjectA, kObjectB, kDistance };

// Half a unit of the last digit written: 0.0005 for "0.125" and for "125e-3".
double rounding_of(std::string_view text) {
  const std::size_t mantissa = std::min(text.find_first_of("eE"), text.size());
  std::int64_t exponent = 0;
  if (mantissa < text.size()) {
    const std::size_t digits = mantissa + (text[mantissa + 1] == '+' ? 2 : 1);
    std::from_chars(text.data() + digits, text.data() + text.size(), exponent);
  }
  const std::size_t point = text.find('.');
  if (point < mantissa) exponent -= static_cast<std::int64_t>(mantissa - point - 1);
  return 0.5 * std::pow(10.0, static_cast<double>(exponent));
}

// A depth counts as contact where the reference does not tell it.
double seen_by(double reference, double ours) {
  return reference == 0.0 && ours < 0.0 ? 0.0 : ours;
}

// References may need more digits than other figures for a person.
std::string precise(double value) { return metres(value, 12); }

}  // namespace

// The whole table is read first, so that a mistake in it is known before the replay runs.
ReferenceCheck::ReferenceCheck(const Scene& scene, const std::filesystem::path& file,
                               std::optional<double> tolerance,
                               const std::map<std::string, double>& mesh_errors)
    : scene_(&scene),
      ids_(pair_ids(scene)),
      tolerance_(tolerance.value_or(kReferenceTolerance)),
      bounds_tolerance_(tolerance.value_or(0.0)) {
  std::array<std::string_view, 4> columns = kColumns;
  const std::vector<std::string> there = csv_column_names(file);
  const auto has = [&](std::string_view name) {
    return std::ranges::find(there, name) != there.end();
  };
  // clearance-replay --csv calls it so.
  if (!has(columns[kTime]) && has("now_ns")) columns[kTime] = "now_ns";
  CsvTable table(file, columns);
  const auto mesh_error = [&](const std::string& object) {
    const auto found = mesh_errors.find(object);
    return found == mesh_errors.end() ? 0.0 : found->second;
  };
  Value value;
  while (table.next() && table.time_ns(kTime, value.t_ns) &&
         table.number(kDistance, value.distance)) {
    value.objects = {std::string(table.text(kObjectA)), std::string(table.text(kObjectB))};
    value.rounding = rounding_of(table.text(kDistance));
    value.mesh_error = mesh_error(value.objects.first) + mesh_error(value.objects.second);
    values_.push_back(value);
  }
  error_ = table.error();
}

ReferenceCheck::PairIds ReferenceCheck::pair_ids(const Scene& scene) {
  PairIds ids;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    const std::string& a = scene.objects[scene.pairs[p].first].name;
    const std::string& b = scene.objects[scene.pairs[p].second].name;
    ids[{a, b}] = ids[{b, a}] = p;
  }
  return ids;
}

void ReferenceCheck::change(const Scene& scene) {
  scene_ = &scene;
  ids_ = pair_ids(scene);
}

// Table and ticks are both in order of time: one pass over both.
std::vector<std::string> ReferenceCheck::check(const Report& report, const Monitor& monitor) {
  std::vector<std::string> broken;
  for (; next_ < values_.size() && values_[next_].t_ns <= report.now_ns; ++next_) {
    const Value& value = values_[next_];
    const auto pair = ids_.find(value.objects);
    if (pair == ids_.end()) {
      if (totals_.other_pairs++ == 0)
        other_pair_ = pair_name(value.objects.first, value.objects.second);
    } else if (value.t_ns < report.now_ns) {
      ++totals_.other_times;
    } else {
      compare(value, monitor.pair(pair->second), broken);
    }
  }
  return broken;
}

// Parts may overlap, by any depth, although the meshes are a little apart.
double ReferenceCheck::least_allowed(const Value& value) {
  if (value.mesh_error == 0.0) return value.distance;
  const double least = value.distance - value.mesh_error;
  return least > 0.0 ? least : -kInfinity;
}

double ReferenceCheck::difference_from(const Value& value, double ours) {
  const double seen = seen_by(value.distance, ours), least = least_allowed(value);
  return std::max({seen - value.distance, least - seen, 0.0});
}

// A carried distance is that of another tick: only its bounds can be held against this one's
// reference.
void ReferenceCheck::compare(const Value& value, const PairReport& ours,
                             std::vector<std::string>& broken) {
  ++totals_.compared;
  const std::string who = pair_name(*scene_, ours);
  const std::string reference = fmt::format(", reference {}", precise(value.distance));
  const bool evaluated = ours.status != PairStatus::kCarried;  // else it is that of another tick
  const double difference = difference_from(value, ours.distance);
  if (evaluated && difference > totals_.largest) totals_.largest = difference;
  if (!(evaluated && difference <= tolerance_) && totals_.off++ == 0) {
    broken.push_back(fmt::format("{}: {}, distance {}{}: not within the tolerance of {}", who,
                                 name(ours.status), precise(ours.distance), reference,
                                 precise(tolerance_)));
  }
  const double slack = value.rounding + bounds_tolerance_;
  const bool within = seen_by(value.distance, ours.lower) <= value.distance + slack &&
                      seen_by(value.distance, ours.upper) >= least_allowed(value) - slack;
  if (!within && totals_.outside++ == 0) {
    broken.push_back(fmt::format("{}: bounds {} to {}{}: outside", who, precise(ours.lower),
                                 precise(ours.upper), reference));
  }
}

// Values after the last tick met no tick either.
ReferenceTotals ReferenceCheck::totals() const {
  ReferenceTotals totals = totals_;
  for (std::size_t i = next_; i < values_.size(); ++i)
    ++(ids_.contains(values_[i].objects) ? totals.other_times : totals.other_pairs);
  return totals;
}

// Sentences about values that were not compared.
std::vector<std::string> ReferenceCheck::notes() const {
  std::vector<std::string> notes;
  const ReferenceTotals all = totals();
  std::string other_pair = other_pair_;
  for (std::size_t i = next_; i < values_.size() && other_pair.empty(); ++i) {
    const auto& [a, b] = values_[i].objects;
    if (!ids_.contains(values_[i].objects)) other_pair = pair_name(a, b);
  }
  if (all.other_pairs > 0) {
    notes.push_back(
        fmt::format("{} reference values are of pairs that the cell does not watch, such as {}",
                    all.other_pairs, other_pair));
  }
  if (all.other_times > 0) {
    notes.push_back(fmt::format(
        "{} reference values are of times at which there is no tick to compare", all.other_times));
  }
  return notes;
}

}  // namespace clearance
