#include "tools/robot/joint_log_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/text/sentences.hpp"
#include "monitor/files/table.hpp"
#include "tools/shared/joint_sweep.hpp"

namespace clearance {
namespace {

// The position that the cell states, or that nearest to 0 within the limits.
double rest_of(const JointVariable& variable) noexcept {
  if (variable.is_held()) return variable.held;
  return std::clamp(0.0, variable.lower, std::max(variable.lower, variable.upper));
}

}  // namespace

JointLogMotion::JointLogMotion(const std::filesystem::path& file, const Scene& scene) {
  for (const JointVariable& variable : scene.variables) resting_.push_back(rest_of(variable));
  const std::vector<std::string> header = csv_column_names(file);
  std::vector<std::string_view> columns = {"t_ns"};
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    if (std::ranges::find(header, scene.variables[i].name) == header.end()) continue;
    columns.push_back(scene.variables[i].name);
    variables_.push_back(i);
  }
  note_columns(header, scene);
  CsvTable table(file, columns);
  while (table.next()) {
    Row row{0, std::vector<double>(variables_.size())};
    bool good = table.time_ns(0, row.t_ns);
    for (std::size_t i = 0; i < variables_.size(); ++i) {
      good = good && table.number(i + 1, row.positions[i]);
    }
    if (good) rows_.push_back(std::move(row));
  }
  error_ = table.error();
  if (error_.empty() && (rows_.empty() || variables_.empty())) {
    error_ = fmt::format("{}: found no {}; expected t_ns and a column for each joint, by its name",
                         file.string(), rows_.empty() ? "rows" : "joint of the cell");
  }
}

void JointLogMotion::note_columns(const std::vector<std::string>& header, const Scene& scene) {
  constexpr std::size_t kNamed = 6;
  std::vector<std::string> unknown, resting;
  for (const std::string& column : header) {
    if (column != "t_ns" &&
        std::ranges::find(scene.variables, column, &JointVariable::name) == scene.variables.end())
      unknown.push_back(column);
  }
  for (const JointVariable& variable : scene.variables) {
    if (std::ranges::find(header, variable.name) == header.end()) resting.push_back(variable.name);
  }
  if (!unknown.empty())
    note_ = fmt::format("found columns of no joint of the cell: {}", listed(unknown, kNamed));
  if (!resting.empty())
    note_ += fmt::format("{}joints without a column rest: {}", note_.empty() ? "" : "; ",
                         listed(resting, kNamed));
}

double JointLogMotion::seconds() const noexcept {
  return rows_.empty() ? 0.0 : 1e-9 * static_cast<double>(rows_.back().t_ns - rows_.front().t_ns);
}

void JointLogMotion::at(double t_s, std::vector<JointSample>& joints) {
  joints.clear();
  for (std::size_t i = 0; i < resting_.size(); ++i)
    joints.push_back(moving_joint(i, resting_[i], 0.0));
  const std::int64_t t_ns = rows_.front().t_ns + std::llround(1e9 * t_s);
  if (t_ns < rows_[at_].t_ns) at_ = 0;
  while (at_ + 1 < rows_.size() && rows_[at_ + 1].t_ns <= t_ns) ++at_;
  const Row& before = rows_[at_];
  const Row& after = rows_[std::min(at_ + 1, rows_.size() - 1)];
  const double span_s = 1e-9 * static_cast<double>(after.t_ns - before.t_ns);
  const double passed_s = 1e-9 * static_cast<double>(t_ns - before.t_ns);
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    const double velocity =
        span_s > 0.0 ? (after.positions[i] - before.positions[i]) / span_s : 0.0;
    joints[variables_[i]] =
        moving_joint(variables_[i], before.positions[i] + velocity * passed_s, velocity);
  }
}

}  // namespace clearance
