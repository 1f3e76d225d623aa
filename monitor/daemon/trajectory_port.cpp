#include "monitor/daemon/trajectory_port.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "monitor/app/log_line.hpp"
#include "monitor/intake/ros_joint_trajectory.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/publish/motion_diagnostics.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr const char* kDiagnostics = "/diagnostics";

// Decodes in the thread of the desk: a motion may begin where the joints are then.
std::string make_motion(std::string_view topic, std::span<const std::byte> cdr, const Scene& scene,
                        const InputState& state, Question& question) {
  auto made = motion_of(topic, cdr, CdrBytes::kOfReader, scene, state);
  if (auto* reason = std::get_if<std::string>(&made)) return std::move(*reason);
  question.motion = std::get<JointTrajectory>(std::move(made));
  return "";
}

}  // namespace

TrajectoryPort::TrajectoryPort(std::string cell, RosTrajectories options, Participant& participant,
                               Put put, RosWrites::Leads leads)
    : cell_(std::move(cell)),
      options_(std::move(options)),
      put_(std::move(put)),
      diagnostics_(participant.ros_writer(kRosDiagnostics, ros_dds_name(kDiagnostics))),
      writes_(std::move(leads)) {
  std::vector<dds_entity_t> readers;
  for (const std::string& name : options_.topics) {
    Topic topic{.name = name};
    topic.reader = participant.ros_reader(kRosJointTrajectory, ros_dds_name(name));
    topic.number = participant.ros_writer(kRosFloat64, ros_dds_name(name + "/clearance"));
    readers.push_back(topic.reader);
    topics_.push_back(std::move(topic));
  }
  wait_ = std::make_unique<DataWait>(participant, readers);
}

void TrajectoryPort::start() {
  thread_ = std::thread([this] { run(); });
}

TrajectoryPort::~TrajectoryPort() {
  stop_ = true;
  wait_->wake();
  if (thread_.joinable()) thread_.join();
  taken_.clear();
  for (const Topic& topic : topics_) {
    dds_delete(topic.reader);
    dds_delete(topic.number);
  }
  dds_delete(diagnostics_);
}

void TrajectoryPort::run() {
  name_thread("trajectories");
  lower_priority();
  while (!stop_) {
    wait_->wait(kSecondNs);
    if (stop_) return;
    try {
      for (Topic& topic : topics_) {
        while (!stop_ && take_cdr(topic.reader, taken_) > 0) {
          for (const CdrSample& sample : taken_) take(topic, sample);
          taken_.clear();
        }
      }
    } catch (const DdsError& error) {
      log_line(lines::kInputsFailed, error.what());
    }
  }
}

// A copy waits for its turn: a reader keeps few messages.
void TrajectoryPort::take(Topic& topic, const CdrSample& sample) {
  QueuedQuestion queued;
  queued.question.client = topic.name;
  queued.question.request = ++topic.last;
  queued.question.question.margins = options_.margins;
  queued.question.question.work_limit = 0;  // that of the cell
  queued.bytes_to_make = sample.bytes().size();
  const auto bytes =
      std::make_shared<const std::vector<std::byte>>(sample.bytes().begin(), sample.bytes().end());
  queued.make = [bytes, name = topic.name](const Scene& scene, const InputState& state,
                                           Question& question) {
    return make_motion(name, *bytes, scene, state, question);
  };
  queued.answer = [this, &topic](const QuestionResult& result) { write(topic, result); };
  if (put_(std::move(queued))) return;
  write(topic, {.client = topic.name,
                .request = topic.last,
                .status = QuestionStatus::kBusy,
                .reason = "found too many motions that wait; expected fewer at a time"});
}

void TrajectoryPort::write(const Topic& topic, const QuestionResult& result) {
  const DiagnosticText status = motion_status(topic.name, result);
  const auto diagnostics = diagnostic_array(cell_, {&status, 1}, dds_time());
  const std_msgs_msg_dds__Float64_ lower{result.lower};
  const Lock lock(mutex_);
  if (!writes_.may_write()) return;
  writes_.write(diagnostics_, &*diagnostics);
  writes_.write(topic.number, &lower);
}

}  // namespace clearance
