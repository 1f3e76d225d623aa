#include "monitor/visual/object_poses.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include "monitor/ask/stopping_joints.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// The largest number of waiting poses and joints of a source: two seconds of thirty objects at 1
// kHz. The oldest are dropped, so a daemon that has ended does not cost more memory.
constexpr std::size_t kMostWaiting = 1 << 16;
// No report ever names this sequence number.
constexpr std::uint64_t kNeverNamed = std::numeric_limits<std::uint64_t>::max();

std::int64_t newest_stamp(const PoseBatch& batch) {
  std::int64_t newest = std::numeric_limits<std::int64_t>::min();
  for (const PoseSample& sample : batch.samples) newest = std::max(newest, sample.stamp_ns);
  for (const JointSample& sample : batch.joints) newest = std::max(newest, sample.stamp_ns);
  return newest;
}

// The initial inputs, the same as those of a monitor.
Inputs inputs_of(const Scene& scene) {
  Inputs inputs = initial_inputs(scene);
  const std::vector<BoundingSphere> spheres =
      bounding_spheres(scene.objects.size(), parts_of(scene));
  for (std::size_t i = 0; i < spheres.size(); ++i)
    inputs.objects[i].bounding_radius = spheres[i].bounding_radius;
  return inputs;
}

}  // namespace

ObjectPoses::ObjectPoses(const Scene& scene)
    : scene_(scene), numbers_(scene), nothing_known_(inputs_of(scene)), inputs_(nothing_known_) {}

void ObjectPoses::forget() {
  waiting_.clear();
  numbers_ = SourceNumbers(scene_);
  inputs_.emplace(nothing_known_);
}

bool ObjectPoses::is_on_time(std::size_t object) const {
  const TrackedObject& state = inputs_->objects[object];
  if (!state.input.has_value || state.absent) return false;
  if (scene_.objects[object].fixed) return true;
  if (state.follows_joints) return !state.joints_late && !state.joints_contradicted;
  return !state.input.contradiction.holds(inputs_->time.now_ns) &&
         age_ns(object) <= scene_.objects[object].age_limit_ns;
}

std::vector<PathFrame> ObjectPoses::along(const Question& question, std::size_t count,
                                          std::span<const double> more) const {
  std::vector<double> positions(scene_.variables.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = position(i);
  std::vector<Pose> carriers(scene_.robots.size());
  for (std::size_t r = 0; r < carriers.size(); ++r) {
    const RobotBase& base = scene_.robots[r].base;
    const Pose* at = base.kind == RobotBase::Kind::kObject ? pose(base.object) : nullptr;
    if (at != nullptr) carriers[r] = *at;
  }
  return path_frames(scene_, question, positions, carriers, count, more);
}

// A motion of one waypoint is a posture.
std::vector<PathFrame::Placed> ObjectPoses::at_standstill() const {
  Question question;
  JointTrajectory& posture = question.motion;
  posture.times = {0.0};
  for (std::uint32_t r = 0; r < scene_.robots.size(); ++r) {
    if (!scene_.robots[r].stopping.is_stated()) continue;
    JointTrajectory motion;
    StoppingJoints joints(scene_, r, motion);
    joints.read(*inputs_);
    if (!joints.is_usable() || joints.is_assumed()) continue;
    for (std::uint32_t v = 0; v < scene_.variables.size(); ++v) {
      if (!joints.has(v)) continue;
      posture.joints.push_back(scene_.variables[v].name);
      posture.positions.push_back(joints.standstill(v));
    }
  }
  if (posture.joints.empty()) return {};
  std::vector<PathFrame> frames = along(question, 1);
  return frames.empty() ? std::vector<PathFrame::Placed>() : std::move(frames.front().links);
}

void ObjectPoses::take(PoseBatch batch, Numbers numbers) {
  if (!made_for(batch, scene_.revision)) return;
  const std::uint64_t number = numbers == Numbers::kOfSender ? batch.sequence_number : kNeverNamed;
  wait(std::move(batch), number);
}

void ObjectPoses::wait(PoseBatch batch, std::uint64_t sequence_number) {
  Waiting& waiting = waiting_[std::string(batch.source.view())];
  waiting.samples += batch.size();
  waiting.batches.push_back({sequence_number, newest_stamp(batch), std::move(batch)});
  while (waiting.samples > kMostWaiting) {
    waiting.samples -= waiting.batches.front().content.size();
    waiting.batches.pop_front();
  }
}

// Links are placed once, after all used batches.
void ObjectPoses::use(const clearance_msg_Distances& report) {
  const std::int64_t newest_ns = less(report.newest_pose_ns, less(0, report.clock_offset_ns));
  for (auto& [source, waiting] : waiting_) take_up_to(0, newest_ns, waiting);
  for (const auto& used : std::span(report.sources._buffer, report.sources._length)) {
    const auto found = waiting_.find(std::string_view(used.source));
    if (found != waiting_.end()) take_up_to(used.sequence_number, newest_ns, found->second);
  }
  const TickTime time{report.now_ns, report.clock_offset_ns};
  ingest(due_.samples, due_.joints, time, scene_, *inputs_);
  inputs_->robots.place(time.now_ns, inputs_->objects);
  due_.samples.clear();
  due_.joints.clear();
}

void ObjectPoses::take_up_to(std::uint64_t sequence_number, std::int64_t stamp_ns,
                             Waiting& waiting) {
  while (!waiting.batches.empty()) {
    Batch& batch = waiting.batches.front();
    if (batch.sequence_number > sequence_number && batch.stamp_ns > stamp_ns) return;
    numbers_.append(batch.content, due_.samples, due_.joints);
    waiting.samples -= batch.content.size();
    waiting.batches.pop_front();
  }
}

}  // namespace clearance
