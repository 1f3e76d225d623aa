// clearance.replay() and check_replay(): monitor/replay/offline_replay.hpp.
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "monitor/replay/offline_replay.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/cell.hpp"
#include "tools/python/module/module.hpp"
#include "tools/python/module/waiting.hpp"

namespace clearance::python {
namespace {

class RefusedReplay : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Writes ticks as records of one layout. It has the pairs, zones and stopping robots of the cell
// that the caller gave. They go by name, also after the recording has changed its cell.
class TickRecords {
 public:
  explicit TickRecords(const Scene& scene) : scene_(scene) {
    for (const ObjectPair& pair : scene.pairs) {
      if (pair.publish) column_of_[names(scene, pair)] = pairs_++;
    }
    zones_ = scene.zones.size();
    for (const Robot& robot : scene.robots)
      if (robot.stopping.is_stated()) stops_.push_back(robot.name);
    for (const Number& number : kNumbers) place(number.name, number.type, 8);
    for (const char* name : kByPair)
      by_pair_.push_back(place(name, format(pairs_, "f8"), 8 * pairs_));
    for (const char* name : kByStop)
      by_stop_.push_back(place(name, format(stops_.size(), "f8"), 8 * stops_.size()));
    stop_pair_ = place("stop_pair", format(stops_.size(), "i4"), 4 * stops_.size());
    minimum_pair_ = place("minimum_pair", "i4", 4);
    status_ = place("status", format(pairs_, "u1"), pairs_);
    zone_active_ = place("zone_active", format(zones_, "?"), zones_);
    stop_validity_ = place("stop_validity", format(stops_.size(), "u1"), stops_.size());
    certified_ = place("minimum_certified", "?", 1);
    size_ = (size_ + 7) / 8 * 8;
  }

  void add(const ReplayedTick& tick) {
    if (tick.cell.scene.revision != revision_) follow(tick.cell.scene);
    const Report& report = tick.report;
    bytes_.resize(bytes_.size() + size_);
    std::byte* const row = bytes_.data() + count_++ * size_;
    if (count_ == 1) first_ns_ = report.now_ns;
    const PairReport& minimum = report.minimum;
    const double known[] = {1e-9 * static_cast<double>(report.now_ns - first_ns_),
                            report.lower_all,
                            report.swept_lower_all,
                            report.minimum_known ? minimum.distance : kUnknown,
                            report.minimum_known ? minimum.lower : -kInfinity,
                            report.minimum_known ? minimum.upper : kInfinity};
    put(row, 0, report.cycle);
    put(row, 8, report.now_ns);
    std::memcpy(row + 16, known, sizeof(known));
    const std::int32_t pair = report.minimum_known ? pair_of_[minimum.pair] : -1;
    put(row, minimum_pair_, pair);
    put(row, certified_, static_cast<std::uint8_t>(report.minimum_certified));
    for (std::size_t i = 0; i < pairs_; ++i) put_pair(row, i, unknown());
    for (std::size_t i = 0; i < report.pairs.size(); ++i) {
      if (columns_[i] >= 0) put_pair(row, static_cast<std::size_t>(columns_[i]), report.pairs[i]);
    }
    for (std::size_t i = 0; i < report.zones.size(); ++i) {
      if (zone_columns_[i] >= 0)
        put(row, zone_active_ + static_cast<std::size_t>(zone_columns_[i]),
            static_cast<std::uint8_t>(report.zones[i].active));
    }
    for (std::size_t i = 0; i < stops_.size(); ++i) put_stop(row, i, kUnknownStop);
    for (const RobotStop& stop : report.stops) {
      if (stop_columns_[stop.robot] >= 0)
        put_stop(row, static_cast<std::size_t>(stop_columns_[stop.robot]), stop);
    }
  }

  // Called with the interpreter's lock.
  [[nodiscard]] py::array take() {
    return records_from(record_dtype(fields_with_names(), size_), std::move(bytes_), count_);
  }

 private:
  struct Number {
    const char *name, *type;
  };
  static constexpr Number kNumbers[] = {{"cycle", "u8"},           {"now_ns", "i8"},
                                        {"time_s", "f8"},          {"lower_all", "f8"},
                                        {"swept_lower_all", "f8"}, {"minimum_distance", "f8"},
                                        {"minimum_lower", "f8"},   {"minimum_upper", "f8"}};
  static constexpr const char* kByPair[] = {"distance",    "lower",      "upper",
                                            "swept_lower", "stop_lower", "closing_speed"};
  static constexpr const char* kByStop[] = {"stop_scaling", "stop_clearance", "stop_share",
                                            "stop_time"};
  static constexpr std::uint32_t kNoPair = ~0u;
  static constexpr RobotStop kUnknownStop = {
      .clearance = -kInfinity, .pair = kNoPair, .time = kUnknown};
  using Names = std::pair<std::string, std::string>;

  static Names names(const Scene& scene, const ObjectPair& pair) {
    Names both{scene.objects[pair.first].name, scene.objects[pair.second].name};
    if (both.second < both.first) std::swap(both.first, both.second);
    return both;
  }
  static std::string format(std::size_t count, const char* type) {
    return fmt::format("({},){}", count, type);
  }
  static PairReport unknown() {
    PairReport pair;
    pair.distance = pair.closing_speed = kUnknown;
    pair.lower = pair.swept_lower = pair.stop_lower = -kInfinity;
    pair.upper = kInfinity;
    return pair;
  }

  std::size_t place(const char* name, std::string type, std::size_t bytes) {
    layout_.push_back({name, std::move(type), size_});
    size_ += bytes;
    return size_ - bytes;
  }
  template <class T>
  static void put(std::byte* row, std::size_t offset, const T& value) {
    std::memcpy(row + offset, &value, sizeof(T));
  }
  void put_pair(std::byte* row, std::size_t column, const PairReport& pair) {
    const double numbers[] = {pair.distance,    pair.lower,      pair.upper,
                              pair.swept_lower, pair.stop_lower, pair.closing_speed};
    for (std::size_t i = 0; i < by_pair_.size(); ++i)
      put(row, by_pair_[i] + 8 * column, numbers[i]);
    put(row, status_ + column, static_cast<std::uint8_t>(pair.status));
  }
  void put_stop(std::byte* row, std::size_t column, const RobotStop& stop) {
    const double numbers[] = {stop.scaling, stop.clearance, stop.share, stop.time};
    for (std::size_t i = 0; i < by_stop_.size(); ++i)
      put(row, by_stop_[i] + 8 * column, numbers[i]);
    put(row, stop_pair_ + 4 * column, stop.pair == kNoPair ? -1 : pair_of_[stop.pair]);
    put(row, stop_validity_ + column, static_cast<std::uint8_t>(stop.validity));
  }
  [[nodiscard]] std::vector<Field> fields_with_names() const {
    std::vector<Field> fields;
    for (const Place& one : layout_) fields.push_back({one.name, one.type.c_str(), one.offset});
    return fields;
  }

  // Finds the columns of this scene's pairs, zones and robots.
  void follow(const Scene& now) {
    revision_ = now.revision;
    std::map<Names, std::int32_t> all;
    for (std::size_t i = 0; i < scene_.pairs.size(); ++i)
      all[names(scene_, scene_.pairs[i])] = static_cast<std::int32_t>(i);
    columns_.clear();
    pair_of_.clear();
    zone_columns_.clear();
    stop_columns_.clear();
    for (const Robot& robot : now.robots) {
      const auto found = std::ranges::find(stops_, robot.name);
      stop_columns_.push_back(
          found == stops_.end() ? -1 : static_cast<std::int32_t>(found - stops_.begin()));
    }
    for (const ObjectPair& pair : now.pairs) {
      const Names key = names(now, pair);
      const auto found = all.find(key);
      pair_of_.push_back(found == all.end() ? -1 : found->second);
      if (!pair.publish) continue;
      const auto column = column_of_.find(key);
      columns_.push_back(column == column_of_.end() ? -1
                                                    : static_cast<std::int32_t>(column->second));
    }
    for (const Zone& zone : now.zones) {
      std::int32_t column = -1;
      for (std::size_t i = 0; i < scene_.zones.size(); ++i) {
        if (scene_.zones[i].name == zone.name) column = static_cast<std::int32_t>(i);
      }
      zone_columns_.push_back(column);
    }
  }

  struct Place {
    const char* name;
    std::string type;
    std::size_t offset;
  };

  const Scene& scene_;
  std::map<Names, std::size_t> column_of_;  // of published pairs
  std::size_t pairs_ = 0, zones_ = 0, size_ = 0;
  std::vector<Place> layout_;
  std::vector<std::string> stops_;  // the robots
  std::vector<std::size_t> by_pair_, by_stop_;
  std::size_t minimum_pair_ = 0, status_ = 0, zone_active_ = 0, certified_ = 0;
  std::size_t stop_pair_ = 0, stop_validity_ = 0;

  std::uint64_t revision_ = 0;
  // Of the scene in force; -1: none.
  std::vector<std::int32_t> columns_, pair_of_, zone_columns_, stop_columns_;

  std::int64_t first_ns_ = 0;
  std::vector<std::byte> bytes_;
  std::size_t count_ = 0;
};

// Looks for signals between ticks; the first one ends the replay.
class Interruption {
 public:
  [[nodiscard]] bool operator()() {
    const auto now = Clock::now();
    if (raised_ || now < look_) return raised_;
    look_ = now + kSlice;
    return raised_ = interrupted();
  }
  [[nodiscard]] bool raised() const noexcept { return raised_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point look_ = Clock::now() + kSlice;
  bool raised_ = false;
};

struct ReplayArguments {
  double start_s = 0.0, end_s = kInfinity;
  std::optional<double> tick_hz;
  std::vector<std::string> joint_topics;
  std::map<std::string, double> joints;
  bool evaluate_all = false;

  [[nodiscard]] OfflineReplayOptions options() const {
    if (std::isnan(start_s) || std::isnan(end_s))
      throw py::value_error("start_s, end_s: found NaN; expected seconds after the first tick");
    if (tick_hz && !(*tick_hz >= 0.0 && *tick_hz <= 1e6))
      throw py::value_error("tick_hz: expected 0 to 1e6 ticks a second, or None");
    OfflineReplayOptions options;
    options.start_s = start_s;
    options.end_s = end_s;
    options.tick_hz = tick_hz;
    options.joint_topics = joint_topics;
    options.joints = joints;
    options.evaluate_all = evaluate_all;
    return options;
  }
};

OfflineReplay run(const CellObject& cell, const std::filesystem::path& recording,
                  OfflineReplayOptions options, TickRecords* records) {
  OfflineReplay result;
  Interruption interruption;
  {
    const Unlocked unlock;
    options.stop = std::ref(interruption);
    result = replay_offline(cell.cell(), recording, options, [records](const ReplayedTick& tick) {
      if (records != nullptr) records->add(tick);
    });
  }
  if (interruption.raised()) throw py::error_already_set();
  if (!result.error.empty()) throw RefusedReplay(result.error);
  return result;
}

void warn(const OfflineReplay& result) {
  if (!result.damage.empty() && PyErr_WarnEx(PyExc_RuntimeWarning, result.damage.c_str(), 1) != 0)
    throw py::error_already_set();
}

py::object replay(const CellObject& cell, const std::filesystem::path& recording, double start_s,
                  double end_s, std::optional<double> tick_hz,
                  std::vector<std::string> joint_topics, std::map<std::string, double> joints,
                  bool evaluate_all) {
  TickRecords records(cell.scene());
  const ReplayArguments arguments{start_s,           end_s,       tick_hz, std::move(joint_topics),
                                  std::move(joints), evaluate_all};
  warn(run(cell, recording, arguments.options(), &records));
  return records.take().attr("view")(py::module_::import("numpy").attr("recarray"));
}

// By the names of two objects or groups, or a zone and "": m.
using BetweenPairs = std::map<std::pair<std::string, std::string>, double>;

OfflineReplay check_replay(const CellObject& cell, const std::filesystem::path& recording,
                           std::optional<double> min_distance, std::vector<std::string> no_zone,
                           const BetweenPairs& between, double allow_unknown, double start_s,
                           double end_s, std::optional<double> tick_hz,
                           std::vector<std::string> joint_topics,
                           std::map<std::string, double> joints, bool evaluate_all) {
  if (min_distance && !std::isfinite(*min_distance))
    throw py::value_error("min_distance: expected a finite distance, m, or None");
  const ReplayArguments arguments{start_s,           end_s,       tick_hz, std::move(joint_topics),
                                  std::move(joints), evaluate_all};
  OfflineReplayOptions options = arguments.options();
  if (!(allow_unknown >= 0.0 && allow_unknown <= 1.0))
    throw py::value_error("allow_unknown: expected a share, 0 to 1");
  options.expect_min_distance = min_distance;
  options.allow_unknown = allow_unknown;
  for (const auto& [names, metres] : between) {
    if (!std::isfinite(metres)) throw py::value_error("between: expected finite distances, m");
    options.expect_between.push_back({metres, names.first, names.second});
  }
  options.expect_no_zone = std::move(no_zone);
  return run(cell, recording, std::move(options), nullptr);
}

py::object closest_distance(const OfflineReplay& r) {
  return r.closest ? py::object(py::float_(r.closest->distance)) : py::object(py::none());
}

}  // namespace

void add_replay(py::module_& module) {
  py::register_exception<RefusedReplay>(module, "ReplayError", PyExc_RuntimeError).doc() =
      "A recording could not be replayed: the text says why.";
  py::class_<OfflineReplay>(module, "ReplayCheck", "The verdict on a replay.")
      .def_property_readonly("ok", &OfflineReplay::ok, "True if no expectation failed.")
      .def_property_readonly("text", &OfflineReplay::text,
                             "Everything that went wrong or is worth knowing, a line each.")
      .def_property_readonly(
          "failures",
          [](const OfflineReplay& r) {
            py::list texts;
            for (const ReplayFailure& failure : r.failures) texts.append(failure.what);
            return texts;
          },
          "The first failure of each expectation: pair or zone, and figures.")
      .def_readonly("notes", &OfflineReplay::notes, "What a person should know, in sentences.")
      .def_readonly("damage", &OfflineReplay::damage,
                    "Not empty: the recording was read up to a damaged place.")
      .def_readonly("ticks", &OfflineReplay::ticks, "The number of ticks.")
      .def_readonly("not_judged", &OfflineReplay::not_judged,
                    "The most ticks in which one expectation was not judged.")
      .def_property_readonly("closest_distance", &closest_distance,
                             "The smallest distance of all ticks, m; None: no pair was known.")
      .def_readonly("closest_pair", &OfflineReplay::closest_pair, "Its name.")
      .def("__repr__", [](const OfflineReplay& r) {
        return fmt::format("<clearance.ReplayCheck: {}, {} ticks>", r.ok() ? "ok" : "failed",
                           r.ticks);
      });
  module.def("replay", &replay, py::arg("cell"), py::arg("recording"), py::kw_only(),
             py::arg("start_s") = 0.0, py::arg("end_s") = kInfinity,
             py::arg("tick_hz") = py::none(), py::arg("joint_topics") = std::vector<std::string>(),
             py::arg("joints") = std::map<std::string, double>(), py::arg("evaluate_all") = false,
             R"(Runs the daemon's tick on a recording; returns a record array, one record a tick.

recording: one of Clearance's own, a bag of ROS 2 (MCAP, SQLite 3, or the folder of either), or joint
positions as CSV. start_s, end_s: the window that is returned, s after the first tick. tick_hz: None:
the recorded ticks, or the cell's rate. joint_topics: of a bag; empty: all named joint_states.
joints: positions that the recording lacks, by name. evaluate_all: every pair in every tick.

Fields: cycle, now_ns, time_s (since the first record); lower_all and swept_lower_all, lower bounds of
all pairs; minimum_distance, minimum_lower, minimum_upper, minimum_certified and minimum_pair (an index
into Cell.pairs, or -1); by published pair, distance, lower, upper, swept_lower, stop_lower,
closing_speed and status (PairStatus); by zone, zone_active; by robot of the cell with `stopping`,
stop_scaling, stop_clearance, stop_share, stop_time, stop_pair (an index, or -1) and stop_validity.
m, m/s, s. Unknown bounds are infinite, other figures NaN.

Raises ReplayError if it cannot be run; warns of a damaged recording. Releases the interpreter's lock;
Ctrl-C ends it.)");
  module.def("check_replay", &check_replay, py::arg("cell"), py::arg("recording"),
             py::arg("min_distance") = py::none(), py::arg("no_zone") = std::vector<std::string>(),
             py::kw_only(), py::arg("between") = BetweenPairs(), py::arg("allow_unknown") = 0.0,
             py::arg("start_s") = 0.0, py::arg("end_s") = kInfinity,
             py::arg("tick_hz") = py::none(), py::arg("joint_topics") = std::vector<std::string>(),
             py::arg("joints") = std::map<std::string, double>(), py::arg("evaluate_all") = false,
             R"(Judges a recording: a ReplayCheck.

min_distance: every pair's distance is certified to be at least this, m. between: the same by pairs,
{("arm", "table"): 0.02}; two objects or groups, or a zone and "". no_zone: names of zones that are
never active. Each is judged from the first tick in which the objects of its pairs are known and on
time. Then a pair may be unknown in this share of the ticks: allow_unknown. The other arguments are
those of replay(). Raises ReplayError if it cannot be run.)");
}

}  // namespace clearance::python
