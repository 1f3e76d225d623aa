#include "monitor/recording/input_log.hpp"

#include <algorithm>

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
  if (bag_format(path) == BagFormat::kOther) {
    return std::make_unique<JointCsvLog>(path, cell.scene, options);
  }
  return std::make_unique<BagLog>(path, cell, options);
}

}  // namespace clearance
