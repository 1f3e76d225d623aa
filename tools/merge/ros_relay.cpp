#include "tools/merge/ros_relay.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "monitor/app/log_line.hpp"
#include "monitor/app/ros_outputs.hpp"
#include "monitor/interface/merge_log_lines.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance::merge {
namespace {

// What no share has reported of a zone or a stop counts as that of a share that is not heard.
void fill_report(const Scene& scene, const client::SharedCell& whole, Report& out) {
  from_wire(*whole, out);
  out.zones.assign(scene.zones.size(), {.active = true, .cause = ZoneCause::kNoShare});
  for (const auto& [id, state] : whole.zones()) {
    if (id < out.zones.size()) from_wire(state, out.zones[id]);
  }
  out.separated_zones.clear();
  out.stops.clear();
  if (whole.separation() != nullptr) from_wire(*whole.separation(), out);
  for (std::uint32_t zone = 0; zone < scene.zones.size(); ++zone) {
    if (!scene.zones[zone].separation) continue;
    const auto is_this = [=](const ZoneSeparation& each) { return each.zone == zone; };
    if (std::ranges::none_of(out.separated_zones, is_this))
      out.separated_zones.push_back({.zone = zone});
  }
  for (std::uint32_t robot = 0; robot < scene.robots.size(); ++robot) {
    if (!scene.robots[robot].stopping.is_stated()) continue;
    const auto is_this = [=](const RobotStop& each) { return each.robot == robot; };
    if (std::ranges::none_of(out.stops, is_this)) out.stops.push_back({.robot = robot});
  }
}

template <class T>
bool is_done(const std::future<T>& future) {
  using namespace std::chrono_literals;
  return future.valid() && future.wait_for(0s) == std::future_status::ready;
}

}  // namespace

RosRelay::RosRelay(Participant& participant, Cell cell, CellOptions options,
                   std::vector<std::string> asked)
    : participant_(participant),
      options_(std::move(options)),
      asked_(std::move(asked)),
      now_(parts_of(std::move(cell))) {}

std::unique_ptr<RosRelay::CellRelay> RosRelay::parts_of(Cell cell) {
  auto parts = std::make_unique<CellRelay>(CellRelay{std::move(cell), nullptr});
  add_asked(asked_, parts->cell.ros.outputs);
  if (!writes_ros(parts->cell)) return parts;
  const auto health = [this](const LoopStatistics&) {
    const Lock lock(mutex_);
    return std::exchange(health_, std::nullopt);
  };
  parts->writer = std::make_unique<RosWriter>(parts->cell, participant_, health);
  return parts;
}

RosRelay::Made RosRelay::read(const std::string& yaml) {
  CellResult result = parse_cell(yaml, now_->cell.file, options_);
  if (const auto* errors = std::get_if<std::vector<CellError>>(&result))
    return errors->empty() ? std::string() : errors->front().text;
  return parts_of(std::get<Cell>(std::move(result)));
}

// No report of the shares waits for new meshes to be read or for a writer to end.
void RosRelay::follow(const clearance_msg_Catalogue& catalogue) {
  const std::uint64_t wanted = catalogue.scene_revision;
  if (is_done(making_)) {
    Made made = making_.get();
    auto* const next = std::get_if<std::unique_ptr<CellRelay>>(&made);
    const bool is_it = next != nullptr && (*next)->cell.scene.revision == wanted;
    if (is_it) std::swap(now_, *next);
    if (!is_it && read_ == wanted) {
      unreadable_ = wanted;
      const std::string* const why = std::get_if<std::string>(&made);
      log_line(lines::kCellNotRead, wanted, why != nullptr ? *why : "the files here are others");
    }
    ending_ = std::async(std::launch::async,
                         [last = std::move(made)]() mutable { last = std::string(); });
  }
  const bool is_running = making_.valid() || (ending_.valid() && !is_done(ending_));
  if (wanted == now_->cell.scene.revision || wanted == unreadable_ || is_running) return;
  read_ = wanted;
  making_ = std::async(std::launch::async, [this, yaml = std::string(catalogue.cell_yaml)] {
    if (const Refusal refusal = use_fifo_scheduling(0)) log_line(lines::kSystemRefuses, *refusal);
    return read(yaml);
  });
}

void RosRelay::write(const client::SharedCell& whole) {
  if (whole.catalogue() == nullptr) return;
  follow(*whole.catalogue());
  if (!now_->writer || whole->scene_revision != now_->cell.scene.revision) return;
  fill_report(now_->cell.scene, whole, report_);
  now_->writer->report(report_, {});
}

void RosRelay::tell(Sample<clearance_msg_Health> health) {
  if (!now_->writer) return;
  {
    const Lock lock(mutex_);
    health_.emplace(std::move(health));
  }
  now_->writer->statistics({});
}

}  // namespace clearance::merge
