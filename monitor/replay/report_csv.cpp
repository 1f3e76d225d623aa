// Builds rows in memory with std::to_chars, the shortest text that reads back exactly, and writes
// them in blocks of 256 KiB.
#include "monitor/replay/report_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <type_traits>
#include <utility>

#include "monitor/files/file_error.hpp"
#include "monitor/interface/pair_name.hpp"
#include "monitor/interface/report_fields.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {
namespace {

// Large enough that writing takes no noticeable time for each tick.
constexpr std::size_t kWriteAt = std::size_t{1} << 18;  // bytes

// Quotes a name as RFC 4180 demands.
std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string out = "\"";
  for (const char c : name) out.append(c == '"' ? 2 : 1, c);
  return out + "\"";
}

// The shortest text that reads back as the same number.
template <class Number>
requires std::is_arithmetic_v<Number>
void put(std::string& row, Number value) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  row.append(text.data(), end);
}

// The columns of a field: its name, or, for vectors, a letter and an axis ("ax"). Empty: the table
// leaves the field out. It names the objects instead of the parts, and numbers the ticks itself.
std::string column_of(std::string_view field) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kOtherwise = {
      {{"pair", ""},
       {"part_a", ""},
       {"part_b", ""},
       {"evaluated_cycle", ""},
       {"witness_a", "a"},
       {"witness_b", "b"},
       {"normal", "n"}}};
  const auto* const found =
      std::ranges::find(kOtherwise, field, &decltype(kOtherwise)::value_type::first);
  return std::string(found == kOtherwise.end() ? field : found->second);
}

// Visits the columns of a pair's fields.
template <class Visit>
void for_each_column(const PairReport& pair, const Visit& visit) {
  for_each_field(
      [&visit]<class Value>(const Field& field, const Value& value) {
        const std::string column = column_of(field.name);
        if (column.empty()) return;
        if constexpr (std::is_same_v<Value, Vec3>) {
          for (int i = 0; i < 3; ++i) visit(column + "xyz"[i], value[i]);
        } else {
          visit(column, value);
        }
      },
      pair);
}

void put(std::string& row, PairStatus status) { row += name(status); }
void put(std::string& row, SeparationValidity validity) { row += name(validity); }

// Visits the columns of a robot's stop. The robot is in their names.
template <class Visit>
void for_each_stop_column(const RobotStop& stop, const Visit& visit) {
  for_each_field(
      [&visit](const Field& field, const auto& value) {
        if (field.name != "robot") visit(field, value);
      },
      stop);
}

}  // namespace

// The header is the first row in memory; it goes to the file with the first block.
ReportCsv::ReportCsv(const std::filesystem::path& file, const Scene& scene, bool all_pairs)
    : path_(file), all_pairs_(all_pairs), file_(std::fopen(file.c_str(), "wb")) {
  if (!file_) {
    error_ = cannot_create(file);
    return;
  }
  follow(scene);
  rows_ = "tick,now_ns,object_a,object_b";
  for_each_column({}, [this](const std::string& column, const auto&) { rows_ += "," + column; });
  rows_ += ",scene_revision,contact,contact_status,contact_depth,blind_shell,unseen";
  for (const Robot& robot : scene.robots) {
    if (!robot.stopping.is_stated()) continue;
    robots_.push_back(robot.name);
    for_each_stop_column({}, [&](const Field& field, const auto&) {
      rows_.append(",").append(quoted(fmt::format("{}/stop_{}", robot.name, field.name)));
    });
  }
  rows_ += '\n';
}

void ReportCsv::follow(const Scene& scene) {
  scene_ = &scene;
  names_.clear();
  for (const Object& object : scene.objects) names_.push_back(quoted(object.name));
  contacts_.clear();
  for (const AllowedContact& contact : scene.contacts) contacts_.push_back(quoted(contact.name));
  revision_ = fmt::format("{:016x}", scene.revision);
}

// Rows are collected and written in large blocks.
void ReportCsv::add(const ReplayedTick& tick) {
  if (!error_.empty()) return;
  if (&tick.cell.scene != scene_) follow(tick.cell.scene);
  note_stops(tick.report);
  // Only published pairs have the figures of stops.
  std::uint32_t next = 0;
  for (const PairReport& published : tick.report.pairs) {
    for (; all_pairs_ && next < published.pair; ++next)
      add_row(tick.report, tick.monitor.pair(next));
    add_row(tick.report, published);
    next = published.pair + 1;
  }
  for (; all_pairs_ && next < scene_->pairs.size(); ++next)
    add_row(tick.report, tick.monitor.pair(next));
  if (rows_.size() >= kWriteAt) write();
}

// Robots are found by name, since a changed cell numbers them otherwise.
void ReportCsv::note_stops(const Report& report) {
  stops_.clear();
  for (const std::string& robot : robots_) {
    const auto found = std::ranges::find_if(report.stops, [&](const RobotStop& stop) {
      return scene_->robots[stop.robot].name == robot;
    });
    const bool is_known = found != report.stops.end();
    for_each_stop_column(is_known ? *found : RobotStop(),
                         [&]<class Value>(const Field&, const Value& value) {
                           stops_ += ',';
                           if (!is_known) return;
                           if constexpr (std::is_same_v<Value, std::uint32_t>) {
                             stops_ += quoted(pair_name(*scene_, value));
                           } else {
                             put(stops_, value);
                           }
                         });
  }
}

// In the order of the header.
void ReportCsv::add_row(const Report& report, const PairReport& pair) {
  const ObjectPair& objects = scene_->pairs[pair.pair];
  put(rows_, report.cycle);
  rows_ += ',';
  put(rows_, report.now_ns);
  rows_.append(",").append(names_[objects.first]).append(",").append(names_[objects.second]);
  for_each_column(pair, [this](const std::string&, const auto& value) {
    rows_ += ',';
    put(rows_, value);
  });
  rows_.append(",").append(revision_);
  add_contact(report, pair.pair);
  add_hidden(report, pair.pair);
  rows_.append(stops_).append("\n");
}

// The columns are empty where no contact is allowed.
void ReportCsv::add_contact(const Report& report, std::uint32_t pair) {
  const auto found = std::ranges::lower_bound(report.contacts, pair, {}, &ContactReport::pair);
  if (found == report.contacts.end() || found->pair != pair) {
    rows_ += ",,,";
    return;
  }
  rows_.append(",").append(contacts_[found->contact]).append(",").append(name(found->status));
  rows_ += ',';
  put(rows_, found->depth);
}

// The columns are empty unless the pair is of a sensor and a link.
void ReportCsv::add_hidden(const Report& report, std::uint32_t pair) {
  const auto found = std::ranges::lower_bound(report.hidden, pair, {}, &HiddenReport::pair);
  if (found == report.hidden.end() || found->pair != pair) {
    rows_ += ",,";
    return;
  }
  rows_ += ',';
  put(rows_, found->thickness);
  rows_ += ',';
  put(rows_, found->unseen);
}

// After an error the rows are dropped: the file is incomplete anyway.
void ReportCsv::write() {
  if (std::fwrite(rows_.data(), 1, rows_.size(), file_.get()) != rows_.size()) {
    error_ = cannot_write(path_);
  }
  rows_.clear();
}

// The last rows, and the errors that only closing shows (a full disk).
bool ReportCsv::close() {
  if (!file_) return error_.empty();
  if (error_.empty()) write();
  if (std::fclose(file_.release()) != 0 && error_.empty()) {
    error_ = cannot_write(path_);
  }
  return error_.empty();
}

}  // namespace clearance
