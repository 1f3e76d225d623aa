#include "monitor/requests/question_desk.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "monitor/ask/completion.hpp"
#include "monitor/ask/named_answer.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/tick/read_inputs.hpp"

namespace clearance {
namespace {

// A change of the scene is known to the loop a little earlier than here.
constexpr std::chrono::milliseconds kUntilSceneFollows{2};
constexpr int kMostWaits = 500;

// A vertex of a body with its share of edges, facets and tables, about.
constexpr std::size_t kBytesOfVertex = 1000;

std::size_t bytes_of(const JointTrajectory& motion) noexcept {
  return sizeof motion + sizeof(std::string) * motion.joints.size() +
         sizeof(double) *
             (motion.times.size() + motion.positions.size() + motion.velocities.size());
}

QuestionResult refusal(const MotionQuestion& question, QuestionStatus status, std::string reason) {
  return {.client = question.client,
          .request = question.request,
          .status = status,
          .reason = std::move(reason)};
}

}  // namespace

std::size_t bytes_of(const QueuedQuestion& queued) noexcept {
  const Question& question = queued.question.question;
  std::size_t bytes =
      sizeof(QueuedQuestion) + queued.bytes_to_make + bytes_of(question.motion) +
      sizeof(double) * question.margins.size() + sizeof(HeldJoint) * question.held.size() +
      sizeof(StatedJoint) * question.joints.size() + sizeof(StatedPose) * question.poses.size();
  for (const JointTrajectory& motion : question.beside) bytes += bytes_of(motion);
  for (const ObjectMotion& motion : question.moving) {
    bytes += sizeof motion + (sizeof(double) + sizeof(Pose)) * motion.times.size();
  }
  for (const Payload& payload : question.payloads) {
    bytes += sizeof payload + sizeof(std::string) * payload.touch.size();
    if (payload.shape) bytes += kBytesOfVertex * payload.shape->vertices.size();
  }
  bytes += sizeof(MarginBetween) * question.margins_between.size();
  if (question.contacts) bytes += sizeof(MeantContact) * question.contacts->size();
  return bytes;
}

QuestionDesk::QuestionDesk(std::shared_ptr<const Cell> cell, TickLoop& loop,
                           const std::atomic<bool>& loop_ended, std::size_t more_clients,
                           Frames frames)
    : settings_(cell->questions),
      frames_(std::move(frames)),
      loop_ended_(loop_ended),
      inputs_(loop, loop_ended),
      queue_(settings_.queue * std::max<std::size_t>(1, settings_.from.size() + more_clients),
             kMostBytes),
      cell_(std::move(cell)) {}

void QuestionDesk::start() {
  for (std::size_t i = 0; i < settings_.threads; ++i) threads_.emplace_back([this] { run(); });
}

// A client that asks too much takes no place of another one.
bool QuestionDesk::put(QueuedQuestion question) {
  const std::string client = question.question.client;
  {
    const Lock lock(mutex_);
    std::size_t& waiting = waiting_[client];
    if (waiting >= settings_.queue) return false;
    ++waiting;
  }
  if (queue_.put(std::move(question))) return true;
  forget(client);
  return false;
}

void QuestionDesk::forget(const std::string& client) {
  const Lock lock(mutex_);
  const auto found = waiting_.find(client);
  if (found != waiting_.end() && --found->second == 0) waiting_.erase(found);
}

void QuestionDesk::follow(std::shared_ptr<const Cell> cell) {
  const Lock lock(mutex_);
  cell_ = std::move(cell);
}

std::shared_ptr<const Cell> QuestionDesk::cell() {
  const Lock lock(mutex_);
  return cell_;
}

void QuestionDesk::end() {
  queue_.close();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void QuestionDesk::run() {
  name_thread("questions");
  lower_priority();
  Place place;
  while (auto next = queue_.next()) {
    forget(next->question.client);
    QuestionResult result;
    try {
      result = answer(*next, place);
    } catch (const std::exception& error) {
      result = refusal(next->question, QuestionStatus::kFailed, error.what());
    }
    next->answer(result);
  }
}

// Inputs and scene belong together: the scene may change between two looks.
std::shared_ptr<const InputState> QuestionDesk::read_inputs(Place& place, InputStates::Time since) {
  for (int i = 0; i < kMostWaits && !loop_ended_; ++i) {
    if (auto present = cell(); present != place.cell) {
      place.asker = std::make_unique<Asker>(present->scene);
      place.cell = std::move(present);
    }
    if (auto state = inputs_.of(place.cell, since)) return state;
    std::this_thread::sleep_for(kUntilSceneFollows);
  }
  return nullptr;
}

QuestionResult QuestionDesk::answer(QueuedQuestion& queued, Place& place) {
  MotionQuestion& asked = queued.question;
  const auto state = read_inputs(place, queued.came);
  if (state == nullptr) {
    return loop_ended_ ? refusal(asked, QuestionStatus::kEnding, "the daemon ends")
                       : refusal(asked, QuestionStatus::kFailed,
                                 "found that the scene is changing; expected one that stays. Ask "
                                 "again");
  }
  const Scene& scene = place.cell->scene;
  QuestionResult result{.client = asked.client,
                        .request = asked.request,
                        .scene_revision = scene.revision,
                        .cycle = state->cycle,
                        .now_ns = state->now_ns};
  const auto refuse = [&](QuestionStatus status, std::string reason) {
    result.status = status;
    result.reason = std::move(reason);
    return result;
  };
  if (asked.scene_revision != 0 && asked.scene_revision != scene.revision) {
    return refuse(QuestionStatus::kOtherRevision,
                  "found another scene in force than the question is about; expected its revision");
  }
  Question& question = asked.question;
  if (queued.make) {
    if (std::string reason = queued.make(scene, *state, question); !reason.empty())
      return refuse(QuestionStatus::kRefused, std::move(reason));
  }
  question.work_limit = question.work_limit == 0
                            ? settings_.work_limit
                            : std::min(question.work_limit, settings_.work_limit);
  // After the inputs: a frame is then not older than the one in use at their tick.
  std::vector<SeenFrame> frames;
  if (frames_ && !scene.sensors.empty()) frames = frames_(scene.revision);
  if (auto reason = complete(scene, *state, std::move(frames), question))
    return refuse(QuestionStatus::kNoInput, *std::move(reason));
  if (auto reason = place.asker->ask(question, place.answer))
    return refuse(QuestionStatus::kRefused, *std::move(reason));
  name_answer(place.answer, question, scene, result);
  const StartDeviation start = start_deviation(scene, *state, question.motion);
  result.start_deviation = start.deviation;
  result.start_joint = start.joint;
  return result;
}

}  // namespace clearance
