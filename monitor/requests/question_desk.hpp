// Answers questions of clients in threads of low priority, from the scene in force and the newest
// inputs of the loop. It knows no DDS.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/interface/motion_question.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/request_queue.hpp"
#include "monitor/requests/input_states.hpp"

namespace clearance {

struct QueuedQuestion {
  MotionQuestion question = {};
  // Gets the answer, in a thread of the desk.
  std::function<void(const QuestionResult&)> answer = {};
  InputStates::Time came = std::chrono::steady_clock::now();
  // Makes the motion by the inputs, in a thread of the desk, before anything else is done. Returns
  // why it cannot; may be empty. The bytes that it holds count as waiting.
  std::function<std::string(const Scene&, const InputState&, Question&)> make = {};
  std::size_t bytes_to_make = 0;
};
[[nodiscard]] std::size_t bytes_of(const QueuedQuestion& queued) noexcept;

class QuestionDesk {
 public:
  // The bytes of questions that may wait.
  static constexpr std::size_t kMostBytes = 64 << 20;

  // `cell` is the one that the loop ticks. `more_clients`: those that put questions beside the ones
  // that the cell names. The loop and `loop_ended`, which is set once its thread
  // has ended, outlive this.
  // `frames` returns the last frames of the sensors of the scene of a revision; empty: there are
  // none. Any thread calls it.
  using Frames = std::function<std::vector<SeenFrame>(std::uint64_t scene_revision)>;
  QuestionDesk(std::shared_ptr<const Cell> cell, TickLoop& loop,
               const std::atomic<bool>& loop_ended, std::size_t more_clients = 0,
               Frames frames = {});
  ~QuestionDesk() { end(); }
  QuestionDesk(const QuestionDesk&) = delete;
  QuestionDesk& operator=(const QuestionDesk&) = delete;

  // Starts the threads.
  void start();
  // Any thread but that of the tick. Returns false if too many questions of this client wait, or
  // after end().
  [[nodiscard]] bool put(QueuedQuestion question);
  // The thread that changes the scene: the loop ticks this cell from now on.
  void follow(std::shared_ptr<const Cell> cell);
  // Once `loop_ended` is set: drops what waits, and waits for the answers that are being found.
  void end();

 private:
  // An asker for the scene of one cell, in one thread.
  struct Place {
    std::shared_ptr<const Cell> cell;
    std::unique_ptr<Asker> asker;
    Answer answer;
  };
  void run();
  [[nodiscard]] QuestionResult answer(QueuedQuestion& queued, Place& place);
  [[nodiscard]] std::shared_ptr<const InputState> read_inputs(Place& place,
                                                              InputStates::Time since);
  [[nodiscard]] std::shared_ptr<const Cell> cell();
  void forget(const std::string& client);

  const QuestionSettings settings_;
  const Frames frames_;
  const std::atomic<bool>& loop_ended_;
  InputStates inputs_;
  RequestQueue<QueuedQuestion> queue_;
  Mutex mutex_;
  GUARDED_BY(mutex_) std::shared_ptr<const Cell> cell_;
  GUARDED_BY(mutex_) std::map<std::string, std::size_t> waiting_;  // by client
  std::vector<std::thread> threads_;
};

}  // namespace clearance
