#include "monitor/replay/recorded_loop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "monitor/files/build_info.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/tick/self_test.hpp"
#include "monitor/wire/partner_state.hpp"

namespace clearance {

namespace {

void restore_former(const SceneHistory& history, const Cell& cell, SceneIds& ids) {
  for (const FormerScene& scene : history.former()) {
    std::vector<std::uint32_t> objects_now;
    for (const std::string& name : scene.objects) {
      const auto& now = cell.scene.objects;
      const auto found = std::ranges::find(now, name, &Object::name);
      objects_now.push_back(found == now.end() ? SceneMap::kNone
                                               : static_cast<std::uint32_t>(found - now.begin()));
    }
    ids.restore(scene.revision, std::move(objects_now));
  }
}

}  // namespace

RecordedLoop::RecordedLoop(SceneHistory& history, MoveItChanges* moveit)
    : history_(history), moveit_(moveit) {
  start(history.first(), history.begins_changed());
  restore_former(history_, *cell_, state_->ids());
}

void RecordedLoop::start(const Cell& cell, bool followed) {
  cell_ = &cell;
  since_ = {};
  next_ = nullptr;
  blind_.clear();
  lacks_state_ = false;
  state_ = std::make_unique<TickState>(cell.scene, TickStateOptions{.followed = followed});
  sensors_ =
      cell.scene.sensors.empty() ? nullptr : std::make_unique<Sensors>(cell, SensorsOptions{true});
  exchange_frames_of(cell);
}

void RecordedLoop::exchange_frames_of(const Cell& cell) {
  names_.emplace(cell.scene);
  frames_ = std::make_unique<FrameExchange>(cell.scene.sensors.size());
  state_->exchange_frames(frames_.get());
}

// A daemon that was started anew has no history, and may have another cell. If the recording does
// not describe that one, the cell stays.
void RecordedLoop::restart(const clearance_msg_Distances& report) {
  const Cell* const cell = history_.cell(report.scene_revision);
  start(cell != nullptr ? *cell : *cell_, false);
  begun_ = false;
}

const Report* RecordedLoop::tick(const TickInput& input) {
  if (input.restart) restart(*input.recorded);
  if (input.joined != 0) join(input);
  if (input.recorded != nullptr && !change_before(*input.recorded)) return nullptr;
  if (moveit_ != nullptr && next_ && state_->cycle() > next_->successor.began_after()) succeed();
  for (const PoseBatch& batch : input.batches) use(batch);
  if (sensors_) take_frames(input);
  const Report& report = state_->tick(input.time);
  state_->clear();
  if (monitor().self_test().failed()) {
    error_ =
        fmt::format("the memory of this program is damaged: {}", monitor().self_test().fault());
    return nullptr;
  }
  const bool goes_on =
      input.recorded == nullptr ? follow_moveit(input) : change_after(*input.recorded);
  return goes_on ? &report : nullptr;
}

const char* RecordedLoop::missing() const noexcept {
  if (lacks_state_)
    return "the state of a partner that this tick goes on from is lost, or of another build or "
           "cell";
  if (!blind_.empty()) return "frames of sensors that this tick used are not in the recording";
  return unclear_.empty() ? nullptr : kPosesMissing;
}

// A frame of a sensor that the state rests on was shown already, or is recorded with this tick.
void RecordedLoop::join(const TickInput& input) {
  joined_ = input.joined;
  begun_ = true;
  from_ = input.recorded->cycle - 1;
  if (next_) state_->give_up();
  next_ = nullptr;
  const auto found = input.state == nullptr ? std::nullopt : from_wire(*input.state, kBuild);
  JoinedState joined(cell_->scene);
  lacks_state_ = !found || found->revision != joined.revision() ||
                 !joined.restore(found->bytes, found->lineage);
  if (lacks_state_) return;
  state_->join(joined);
  for (std::uint32_t sensor = 0; sensor < cell_->scene.sensors.size(); ++sensor) {
    if (monitor().awaited_frame(sensor) == 0) {
      blind_.erase(sensor);
    } else {
      blind_.insert(sensor);
    }
  }
  unclear_.clear();
}

// The joints of this tick come first: they may be those at the stamp of a frame.
void RecordedLoop::take_frames(const TickInput& input) {
  const std::int64_t now_ns = input.time.now_ns;
  if (input.recorded != nullptr) return rebuild_frames(input);
  const Now now{.realtime_ns = less(now_ns, less(0, input.time.clock_offset_ns)),
                .monotonic_ns = now_ns};
  sensors_->add(state_->samples(), state_->joints(), now.realtime_ns);
  for (const auto& message : input.sensors) sensors_->add(*message, now);
  sensors_->settle(
      now_ns, [this](const SeenCloud* cloud) { return state_->uses(cloud); },
      [this](std::uint32_t sensor, const SensorFrame& frame) {
        frames_->put(sensor, frame, cell_->scene.revision);
      });
}

// What a frame hides may depend on those before, so each one that the daemon built is built again.
void RecordedLoop::rebuild_frames(const TickInput& input) {
  const Scene& scene = cell_->scene;
  for (const RecordedFrame& recorded : input.frames) {
    const auto of_other = translated(recorded.frame);
    const BuiltFrame& frame = of_other ? *of_other : recorded.frame;
    const bool is_shown = recorded.cycle == input.recorded->cycle;
    const bool is_of_cell =
        frame.sensor < scene.sensors.size() && frame.scene_revision == scene.revision;
    const std::uint64_t content = is_of_cell ? names_->name(frame) : 0;
    const bool is_built = sensors_->rebuild(
        frame, [this](const SeenCloud* cloud) { return state_->uses(cloud); },
        [&](std::uint32_t sensor, SensorFrame built) {
          if (!is_shown) return;
          built.content = content;
          frames_->put(sensor, built, scene.revision);
        });
    if (is_built && is_shown) blind_.erase(frame.sensor);
    if (!is_built) blind_.insert(frame.sensor);
  }
}

// The frame as one of the cell that the recording is replayed with, if that is another one.
std::optional<BuiltFrame> RecordedLoop::translated(const BuiltFrame& frame) {
  if (frame.scene_revision == cell_->scene.revision) return std::nullopt;
  auto [map, is_new] = frame_maps_.try_emplace(frame.scene_revision);
  if (is_new) {
    if (const Cell* const recorded = history_.recorded(frame.scene_revision))
      map->second.emplace(recorded->scene, cell_->scene);
  }
  return map->second ? map->second->translate(frame) : std::nullopt;
}

// A message waits while the scene changes because of the one before it.
bool RecordedLoop::follow_moveit(const TickInput& input) {
  if (moveit_ == nullptr) return true;
  for (const auto& scene : input.scenes) moveit_->add(scene);
  if (next_) return true;
  const Cell* const cell = moveit_->next(monitor());
  return cell == nullptr || begin(*cell, state_->cycle() + 1);
}

void RecordedLoop::use(const PoseBatch& batch) {
  if (state_->use(batch)) {
    if (!unclear_.empty()) unclear_.erase(batch.source.c_str());
    return;
  }
  ++of_other_scenes_;
  if (history_.begins_changed() && batch.scene_revision != 0) unclear_.insert(batch.source.c_str());
}

// A file that continues a recording may begin with the first report of a changed scene. The scene
// at its head is then the one before.
void RecordedLoop::begin_with(const clearance_msg_Distances& report) {
  begun_ = true;
  from_ = report.cycle;
  if (report.cycle > 1) {  // the frames in use may be from before
    for (std::uint32_t i = 0; i < cell_->scene.sensors.size(); ++i) blind_.insert(i);
  }
  const Cell* const cell = history_.cell(report.scene_revision);
  if (state_->cycle() > 0 || cell == nullptr || cell == cell_) return;
  start(*cell, true);
  restore_former(history_, *cell, state_->ids());
  const Scene& before = history_.first().scene;
  state_->ids().restore(before.revision, scene_map(before, cell->scene).objects_now);
}

// The changes that are in force with this report. The first one of a recording begins where it can
// if the recording begins between the two steps.
bool RecordedLoop::change_before(const clearance_msg_Distances& report) {
  if (!begun_) begin_with(report);
  const DescribedScene* change = history_.next_change(report.daemon, joined_, from_);
  for (; change != nullptr && change->since.from <= report.cycle;
       change = history_.next_change(report.daemon, joined_, from_)) {
    if (!next_ && !begin(*change)) return false;
    succeed();
  }
  return true;
}

bool RecordedLoop::change_after(const clearance_msg_Distances& report) {
  if (next_) return true;
  const DescribedScene* const change = history_.next_change(report.daemon, joined_, from_);
  const bool due = change != nullptr && change->since.began_after <= report.cycle;
  return !due || begin(*change);
}

bool RecordedLoop::begin(const DescribedScene& change) {
  const Cell* const cell = history_.cell(change.revision);
  if (cell == nullptr) {
    error_ = fmt::format(
        "the recorded cell {:016x}, in force from cycle {} of the daemon, cannot be used: {}",
        change.revision, change.since.from, history_.error());
    return false;
  }
  return begin(*cell, change.since.from);
}

bool RecordedLoop::begin(const Cell& cell, std::uint64_t from) {
  next_.reset(new Next{&cell, from, {*state_, cell.scene, records_}});
  if (state_->begin(next_->successor)) return true;
  error_ = "the recorded cells name more sources than a daemon has places for";
  return false;
}

void RecordedLoop::succeed() {
  const bool is_same = std::exchange(cell_, next_->cell) == next_->cell;
  state_->succeed();
  since_ = next_->successor.in_force();
  const SourceNumbers& numbers = state_->ids().sources();
  if (cell_->scene.sensors.empty()) {
    sensors_ = nullptr;
  } else if (!sensors_) {
    sensors_ = std::make_unique<Sensors>(*cell_, SensorsOptions{true}, numbers);
  } else if (!is_same) {
    sensors_ = std::make_unique<Sensors>(*cell_, *sensors_, numbers);
  }
  if (!is_same) exchange_frames_of(*cell_);
  from_ = next_->from;
  next_ = nullptr;
}

}  // namespace clearance
