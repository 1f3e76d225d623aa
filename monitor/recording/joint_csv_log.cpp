#include "monitor/recording/joint_csv_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/text/sentences.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTime = "t_ns";
constexpr std::string_view kVelocity = "/velocity";

}  // namespace

JointCsvLog::JointCsvLog(const std::filesystem::path& file, const Scene& scene,
                         const InputLogOptions& options)
    : scene_(scene),
      file_(file),
      header_(csv_column_names(file)),
      given_(scene, options.joints),
      given_positions_(options.joints),
      slow_(scene) {
  error_ = given_.error();
  choose_columns();
  if (!error_.empty()) return;
  if (joints_.empty() && !header_.empty()) {
    const std::vector<std::string> names = joint_names(scene);
    error_ =
        fmt::format("{}:1: no column has the name of a joint of this cell; expected t_ns and {}",
                    file.string(), names.empty() ? "joints, but it has none" : one_of(names));
    return;
  }
  table_.emplace(file, columns_);
  error_ = table_->error();
}

void JointCsvLog::choose_columns() {
  columns_.push_back(kTime);
  const JointNames names(scene_);
  const auto variable_of = [&](std::string_view name) {
    const std::uint32_t variable = names.find(name);
    return variable < scene_.variables.size() ? std::optional(variable) : std::nullopt;
  };
  for (const std::string& column : header_) {
    const auto variable = variable_of(column);
    if (!variable) {
      const bool velocity = column.ends_with(kVelocity);
      if (column != kTime && !velocity) left_out_.push_back(column);
      continue;
    }
    heard_.insert(column);
    if (given_positions_.contains(column)) continue;
    joints_.push_back({*variable, columns_.size(), std::nullopt});
    columns_.push_back(column);
  }
  for (Joint& joint : joints_) {
    const std::string name = scene_.variables[joint.variable].name + std::string(kVelocity);
    const auto column = std::ranges::find(header_, name);
    if (column == header_.end()) continue;
    joint.velocity = columns_.size();
    columns_.push_back(*column);
  }
  // A joint state has velocities for all joints or for none.
  if (!std::ranges::all_of(joints_,
                           [](const Joint& joint) { return joint.velocity.has_value(); })) {
    for (Joint& joint : joints_) joint.velocity.reset();
  }
}

// After each row comes a batch with the positions of joints that the user gave, at the same time.
bool JointCsvLog::next(LoggedBatch& batch) {
  if (given_batch_) {
    batch = std::move(*given_batch_);
    given_batch_.reset();
    return true;
  }
  if (!table_ || !error_.empty()) return false;
  batch = {};
  bool sound = table_->next() && table_->time_ns(0, batch.log_ns);
  for (std::size_t i = 0; sound && i < joints_.size(); ++i) {
    JointSample& sample = batch.batch.joints.emplace_back();
    sample.variable = joints_[i].variable;
    sample.stamp_ns = batch.log_ns;
    sound = table_->number(joints_[i].column, sample.position);
    sample.has_velocity = joints_[i].velocity.has_value();
    if (sound && sample.has_velocity) sound = table_->number(*joints_[i].velocity, sample.velocity);
  }
  if (!sound) {
    error_ = table_->error();
    if (error_.empty() && sequence_ == 0) error_ = fmt::format("{} has no rows", file_.string());
    return false;
  }
  batch.batch.source = SourceName("csv");
  slow_.note(batch.batch, slow_notes_);
  batch.batch.sequence_number = ++sequence_;
  if (!given_.empty()) given_batch_ = LoggedBatch{given_.at(batch.log_ns), batch.log_ns};
  return true;
}

std::vector<std::string> JointCsvLog::notes() const {
  std::vector<std::string> notes;
  std::string names;
  for (const std::string& column : left_out_) names += (names.empty() ? "" : ", ") + column;
  if (!names.empty())
    notes.push_back(fmt::format("columns that are no joints of the cell were left out: {}", names));
  notes.insert(notes.end(), slow_notes_.texts.begin(), slow_notes_.texts.end());
  note_unheard(scene_, heard_, given_positions_, notes);
  return notes;
}

}  // namespace clearance
