#include "monitor/recording/input_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "monitor/files/reader.hpp"
#include "monitor/files/table.hpp"
#include "monitor/recording/bag_log.hpp"
#include "monitor/recording/joint_csv_log.hpp"

namespace clearance {
namespace {

bool is_ours(const McapChannel& channel) { return channel.schema.name.starts_with("clearance::"); }

// The summary of a closed file lists its topics. Without a summary, the first messages show them.
bool holds_topics_of_ours(const std::filesystem::path& path) {
  constexpr int kEnough = 1000;
  McapReader reader(path);
  if (!reader.readable()) return true;  // the recording's reader then reports the fault
  if (reader.summary() && !reader.summary()->channels.empty()) {
    return std::ranges::any_of(reader.summary()->channels,
                               [](const auto& channel) { return is_ours(channel.second); });
  }
  McapMessage message;
  int met = 0;
  for (; met < kEnough && reader.next(message); ++met) {
    if (is_ours(*message.channel)) return true;
  }
  return met == 0;
}

// Distinguishes a table of joint positions from a pose log. Both have a column t_ns, but only a
// pose log has a column `object`.
bool is_joint_table(const std::filesystem::path& path) {
  const std::vector<std::string> columns = csv_column_names(path);
  return columns.size() > 1 && std::ranges::find(columns, "t_ns") != columns.end() &&
         std::ranges::find(columns, "object") == columns.end();
}

// A log that cannot be read with this cell.
class RefusedLog final : public InputLog {
 public:
  explicit RefusedLog(std::string error) : error_(std::move(error)) {}
  [[nodiscard]] bool next(LoggedBatch&) override { return false; }
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] bool readable() const noexcept override { return false; }
  [[nodiscard]] double progress() const noexcept override { return 0.0; }
  [[nodiscard]] std::vector<std::string> notes() const override { return {}; }

 private:
  std::string error_;
};

}  // namespace

bool is_input_log(const std::filesystem::path& path) {
  switch (bag_format(path)) {
    case BagFormat::kFolder:
    case BagFormat::kSqlite:
      return true;
    case BagFormat::kMcap:
      return !holds_topics_of_ours(path);
    case BagFormat::kOther:
      break;
  }
  return is_joint_table(path);
}

std::unique_ptr<InputLog> open_input_log(const std::filesystem::path& path, const Cell& cell,
                                         const InputLogOptions& options) {
  const bool is_table = bag_format(path) == BagFormat::kOther;
  // Without the lists, a person that the cell states as absent would stay so.
  if (!cell.ros.moveit.tracked_bodies.empty() && (is_table || !options.with_scenes)) {
    return std::make_unique<RefusedLog>(fmt::format(
        "{} cannot be used with this cell: 'tracked_bodies' of 'ros2' says that lists of bodies "
        "change it, and {}; replay a bag that has the lists, or leave out 'tracked_bodies' and "
        "state the 'id' of each person",
        path.string(),
        is_table ? "a table has none" : "a recording that is made of a log keeps one cell"));
  }
  if (is_table) return std::make_unique<JointCsvLog>(path, cell.scene, options);
  return std::make_unique<BagLog>(path, cell, options);
}

}  // namespace clearance
