#include "tools/scene/error_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "config/scene/stated_errors.hpp"
#include "monitor/files/table.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/replay/explained_places.hpp"
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
  explicit OnePosture(const Scene& scene) : scene_(scene) {}

  void place(std::span<const double> positions) {
    std::vector<JointSample> joints(positions.size());
    // To a monitor that has heard other positions, these might be a leap.
    monitor_ = std::make_unique<Monitor>(scene_, monitor_.get());
    for (int tick = 0; tick < 2; ++tick) {
      now_ns_ += kTickNs;
      for (std::uint32_t v = 0; v < joints.size(); ++v) {
        joints[v].variable = v;
        joints[v].position = positions[v];
        joints[v].stamp_ns = now_ns_;
      }
      monitor_->tick({}, joints, now_ns_);
    }
  }
  [[nodiscard]] const Monitor& monitor() const noexcept { return *monitor_; }

 private:
  const Scene& scene_;
  std::unique_ptr<Monitor> monitor_;
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
  const auto found = link_by_name(scene, link);
  if (const auto* fault = std::get_if<std::string>(&found)) return ErrorReportFault{*fault};
  const LinkByName& tip = std::get<LinkByName>(found);
  if (StatedErrors(scene).source_of_link(tip.robot, tip.link) == ErrorSource::kNone)
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
  ExplainedPlaces places(scene, tip);
  OnePosture posture(scene);
  while (rows.error().empty() && rows.next()) {
    Vec3 measured;
    bool is_read = true;
    for (std::size_t i = 0; i < 3; ++i)
      is_read = is_read && rows.number(i, measured[static_cast<Eigen::Index>(i)]);
    for (std::size_t v = 0; v < positions.size(); ++v)
      is_read = is_read && (column_of[v] == 0 || rows.number(column_of[v], positions[v]));
    if (!is_read) break;
    posture.place(positions);
    if (!places.add(posture.monitor(), measured))
      return ErrorReportFault{rows.located(
          "the link is not known in this posture; expected a column for each joint of its robot, "
          "within the limits of the URDF, and a base that stands still")};
  }
  if (!rows.error().empty()) return ErrorReportFault{rows.error()};
  if (places.size() == 0) return ErrorReportFault{table.string() + " has no rows; expected places"};
  return MeasuredReport{places.text(), places.factor() <= 1.0};
}

}  // namespace clearance
