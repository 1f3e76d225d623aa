#include "tools/scene/error_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "config/scene/stated_errors.hpp"
#include "config/text/spelling.hpp"
#include "monitor/files/table.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kTickNs = 1'000'000;
constexpr std::size_t kShown = 4;  // sources of a pair

double millimetres(double metres) noexcept { return 1e3 * metres; }

double zero_or_next(const JointVariable& variable) noexcept {
  return std::clamp(0.0, variable.lower, variable.upper);
}

// A monitor of the cell in one posture. Two ticks, so that pairs are evaluated as when it runs.
class OnePosture {
 public:
  explicit OnePosture(const Scene& scene) : scene_(scene), monitor_(scene) {}

  void place(std::span<const double> positions) {
    std::vector<JointSample> joints(positions.size());
    for (int tick = 0; tick < 2; ++tick) {
      now_ns_ += kTickNs;
      for (std::uint32_t v = 0; v < joints.size(); ++v) {
        joints[v].variable = v;
        joints[v].position = positions[v];
        joints[v].stamp_ns = now_ns_;
      }
      monitor_.tick({}, joints, now_ns_);
    }
  }
  [[nodiscard]] const Monitor& monitor() const noexcept { return monitor_; }

 private:
  const Scene& scene_;
  Monitor monitor_;
  std::int64_t now_ns_ = kTickNs;
};

std::string shares_text(const Scene& scene, const Monitor& monitor, std::uint32_t pair) {
  const std::vector<ErrorShare> shares = monitor.error_shares(pair);
  std::string text;
  double rest = monitor.pair(pair).model_error;
  for (std::size_t i = 0; i < std::min(kShown, shares.size()); ++i) {
    const ErrorSource& source = monitor.stated_errors().sources()[shares[i].source];
    text += fmt::format("{}{:.2f} {}", i == 0 ? "" : ", ", millimetres(shares[i].metres),
                        text_of(source, scene));
    rest -= shares[i].metres;
  }
  if (rest > 5e-6) text += fmt::format(", {:.2f} the rest", millimetres(rest));
  return text;
}

// A place of the link that was measured.
struct MeasuredPlace {
  Vec3 residual;  // from the model's place to the measured one, m
  // What each source can do along a direction follows from these, in the world.
  struct Source {
    std::uint32_t index;
    Vec3 arm, axis;  // from its origin to the place; unit
  };
  std::vector<Source> sources;
};

// The largest displacement along a unit direction by the stated error of a source, m, without that
// of its joint's position, and with it.
double without_position(const ErrorSource& source, const MeasuredPlace::Source& at,
                        const Vec3& n) noexcept {
  return source.translation + source.rotation * at.arm.cross(n).norm();
}
double by_position(const ErrorSource& source, const MeasuredPlace::Source& at, const Vec3& n,
                   double error) noexcept {
  const bool slides = source.slide > 0.0;
  return error * std::abs(slides ? at.axis.dot(n) : at.axis.dot(at.arm.cross(n)));
}

// Unit directions that are spread evenly.
std::vector<Vec3> spread_directions() {
  constexpr int kCount = 2000;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount, r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

class Comparison {
 public:
  Comparison(const Scene& scene, const StatedErrors& errors)
      : scene_(scene), sources_(errors.sources()), directions_(spread_directions()) {}

  void add(MeasuredPlace place) { places_.push_back(std::move(place)); }
  [[nodiscard]] MeasuredReport report() const;

 private:
  // The factor by which all stated errors have to grow so that they explain the place. A residual
  // is explained if it is no longer, along every direction, than the errors allow.
  [[nodiscard]] double factor(const MeasuredPlace& place) const {
    double most = 0.0;
    for (const Vec3& n : directions_) {
      const double wanted = place.residual.dot(n);
      if (!(wanted > 0.0)) continue;
      double allowed = 0.0;
      for (const MeasuredPlace::Source& at : place.sources) {
        const ErrorSource& source = sources_[at.index];
        allowed += without_position(source, at, n) +
                   by_position(source, at, n, source.turn + source.slide);
      }
      most = std::max(most, wanted / allowed);
    }
    return most;
  }
  // The least position error of this source with which all places are explained, the others being
  // as stated; infinity: none is.
  [[nodiscard]] double least_position(std::uint32_t index) const;

  const Scene& scene_;
  const std::vector<ErrorSource>& sources_;
  std::vector<Vec3> directions_;
  std::vector<MeasuredPlace> places_;
};

double Comparison::least_position(std::uint32_t index) const {
  double least = 0.0;
  for (const MeasuredPlace& place : places_) {
    for (const Vec3& n : directions_) {
      double wanted = place.residual.dot(n), reach = 0.0;
      for (const MeasuredPlace::Source& at : place.sources) {
        const ErrorSource& source = sources_[at.index];
        wanted -= without_position(source, at, n);
        if (at.index == index) {
          reach = by_position(source, at, n, 1.0);
        } else {
          wanted -= by_position(source, at, n, source.turn + source.slide);
        }
      }
      if (wanted > 0.0) least = std::max(least, wanted / reach);
    }
  }
  return least;
}

MeasuredReport Comparison::report() const {
  std::vector<double> lengths;
  double most = 0.0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    lengths.push_back(places_[i].residual.norm());
    const double needed = factor(places_[i]);
    if (needed > most) worst = i;
    most = std::max(most, needed);
  }
  const Vec3 off = 1e3 * places_[worst].residual;
  std::ranges::sort(lengths);
  MeasuredReport report;
  report.explained = most <= 1.0;
  report.text = fmt::format(
      "{} places: the model is off by {:.2f} mm in the median, {:.2f} at most\n"
      "worst: row {}, off by ({:.2f}, {:.2f}, {:.2f}) mm\n"
      "{}: all places are within {:.3g} times the stated errors\n",
      places_.size(), millimetres(lengths[lengths.size() / 2]), millimetres(lengths.back()),
      worst + 1, off.x(), off.y(), off.z(), report.explained ? "explained" : "NOT EXPLAINED", most);
  std::string joints;
  for (const MeasuredPlace::Source& at : places_.front().sources) {
    const ErrorSource& source = sources_[at.index];
    if (!(source.turn + source.slide > 0.0)) continue;
    const double least = least_position(at.index);
    const std::string unit = source.slide > 0.0 ? "mm" : "mrad";
    joints += fmt::format("  {:<40} {:>10.3f} {:>12} {}\n", text_of(source, scene_),
                          1e3 * (source.turn + source.slide),
                          least < kInfinity ? fmt::format("{:.3f}", 1e3 * least) : "none", unit);
  }
  if (!joints.empty())
    report.text += fmt::format("\n  {:<40} {:>10} {:>12}\n{}", "position error of", "stated",
                               "would do", joints) +
                   "'would do': the least that explains all places if only this one changes\n";
  return report;
}

struct MeasuredTip {
  std::uint32_t robot = 0, link = 0;
};

std::variant<MeasuredTip, ErrorReportFault> tip_named(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    for (std::uint32_t l = 0; l < scene.robots[r].links.size(); ++l) {
      names.push_back(scene.robots[r].links[l].name);
      if (names.back() == name) return MeasuredTip{r, l};
    }
  }
  return ErrorReportFault{
      fmt::format("found no link '{}'; expected a link of a robot of the cell{}", name,
                  did_you_mean(name, names))};
}

// The sources that carry the tip, and the tip, in a posture.
std::optional<MeasuredPlace> place_of(const Monitor& monitor, const MeasuredTip& tip,
                                      const Vec3& measured) {
  const PresentPose at = monitor.present_link(tip.robot, tip.link);
  if (at.state != PresentPose::State::kUsable) return std::nullopt;
  const StatedErrors& errors = monitor.stated_errors();
  MeasuredPlace place;
  place.residual = measured - at.world_from_body.position;
  for (std::uint32_t s = errors.source_of_link(tip.robot, tip.link); s != ErrorSource::kNone;
       s = errors.sources()[s].parent) {
    const ErrorSource& source = errors.sources()[s];
    const PresentPose by = source.on_link ? monitor.present_link(source.robot, source.link)
                                          : monitor.present_pose(source.object);
    if (by.state != PresentPose::State::kUsable) return std::nullopt;
    const Pose& pose = by.world_from_body;
    place.sources.push_back({.index = s,
                             .arm = at.world_from_body.position - transform(pose, source.origin),
                             .axis = pose.orientation.normalized() * source.axis});
  }
  return place;
}

}  // namespace

std::variant<std::string, ErrorReportFault> error_table(
    const Scene& scene, const std::map<std::string, double>& joints) {
  if (!StatedErrors(scene).any())
    return ErrorReportFault{"the cell states no errors; expected `errors:` (config/KEYS.md)"};
  const GivenJoints given(scene, joints);
  if (!given.error().empty()) return ErrorReportFault{given.error()};
  Scene evaluated = scene;
  evaluated.evaluate_all = true;
  std::vector<double> positions;
  for (const JointVariable& variable : scene.variables) {
    const auto stated = joints.find(variable.name);
    positions.push_back(stated != joints.end() ? stated->second : zero_or_next(variable));
  }
  OnePosture posture(evaluated);
  posture.place(positions);
  std::vector<std::pair<double, std::uint32_t>> pairs;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    const PairReport report = posture.monitor().pair(p);
    if (report.status < PairStatus::kUnknown) pairs.emplace_back(report.model_error, p);
  }
  std::ranges::sort(pairs, std::ranges::greater{});
  std::string text = fmt::format("{:>9} {:>9}  {:<44} {}\n", "error, mm", "distance", "pair",
                                 "by source, mm, worst first");
  for (const auto& [error, p] : pairs) {
    const auto& [a, b, publish] = scene.pairs[p];
    text += fmt::format("{:>9.2f} {:>9.1f}  {:<44} {}\n", millimetres(error),
                        millimetres(posture.monitor().pair(p).distance),
                        scene.objects[a].name + " - " + scene.objects[b].name,
                        shares_text(scene, posture.monitor(), p));
  }
  const std::size_t unknown = scene.pairs.size() - pairs.size();
  if (unknown > 0) text += fmt::format("{} pairs have a body whose pose has to arrive\n", unknown);
  return text;
}

std::variant<MeasuredReport, ErrorReportFault> measured_report(const Scene& scene,
                                                               const std::filesystem::path& table,
                                                               const std::string& link) {
  const auto tip = tip_named(scene, link);
  if (const auto* fault = std::get_if<ErrorReportFault>(&tip)) return *fault;
  const StatedErrors errors(scene);
  if (errors.source_of_link(std::get<MeasuredTip>(tip).robot, std::get<MeasuredTip>(tip).link) ==
      ErrorSource::kNone)
    return ErrorReportFault{fmt::format(
        "the cell states no errors for '{}'; expected `errors:` (config/KEYS.md)", link)};
  const std::vector<std::string> header = csv_column_names(table);
  std::vector<std::string_view> columns = {"x", "y", "z"};
  std::vector<double> positions;
  std::vector<std::size_t> column_of;  // by variable; 0: none
  for (const JointVariable& variable : scene.variables) {
    positions.push_back(zero_or_next(variable));
    const bool is_there = std::ranges::find(header, variable.name) != header.end();
    column_of.push_back(is_there ? columns.size() : 0);
    if (is_there) columns.push_back(variable.name);
  }
  CsvTable rows(table, columns);
  OnePosture posture(scene);
  Comparison comparison(scene, errors);
  std::size_t count = 0;
  while (rows.error().empty() && rows.next()) {
    Vec3 measured;
    for (std::size_t i = 0; i < 3; ++i)
      if (!rows.number(i, measured[static_cast<Eigen::Index>(i)])) break;
    for (std::size_t v = 0; v < positions.size(); ++v)
      if (column_of[v] > 0 && !rows.number(column_of[v], positions[v])) break;
    if (!rows.error().empty()) break;
    posture.place(positions);
    auto place = place_of(posture.monitor(), std::get<MeasuredTip>(tip), measured);
    if (!place)
      return ErrorReportFault{rows.located(
          "the link is not known in this posture; expected a column for each joint of its robot, "
          "within the limits of the URDF, and a base that stands still")};
    comparison.add(std::move(*place));
    ++count;
  }
  if (!rows.error().empty()) return ErrorReportFault{rows.error()};
  if (count == 0) return ErrorReportFault{table.string() + " has no rows; expected places"};
  return comparison.report();
}

}  // namespace clearance
