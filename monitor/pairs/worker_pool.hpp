// Threads that share one loop with the thread of the tick.
//
// The work of each index is done once, by the thread that claims it first, and must not depend on
// the thread. Then results are the same bits for any number of workers. There are no locks and no
// heap: indices are claimed by one atomic word. A thread without work spins for a while and then
// sleeps on a futex, so that fewer processors than workers cost time and never hang.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace clearance {

class WorkerPool {
 public:
  // `workers` in all, 1 or more; the caller of run() is one of them. Each of the other threads
  // calls `on_start` first, for its name and scheduling; empty: nothing.
  WorkerPool(unsigned workers, const std::function<void()>& on_start);
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  // How a loop is shared: `claim` indices are claimed at once; a loop of fewer than `least` is left
  // to the caller.
  struct Share {
    std::uint32_t claim, least;
  };

  // Calls work(i) once for each i < count, in no particular order and concurrently, and returns
  // when all are done. `work` is noexcept. There may be one caller at a time.
  template <class Work>
  void run(std::uint32_t count, Share share, const Work& work) noexcept {
    run(
        count, share,
        [](const void* context, std::uint32_t i) noexcept {
          (*static_cast<const Work*>(context))(i);
        },
        &work);
  }

 private:
  using Call = void (*)(const void* context, std::uint32_t i) noexcept;

  void run(std::uint32_t count, Share share, Call call, const void* context) noexcept;
  void serve() noexcept;
  [[nodiscard]] bool help() noexcept;
  void wait_until_done(std::uint32_t count) noexcept;

  // Upper half: number of the loop; lower half: how many of its indices are not claimed yet. A
  // claim that succeeds was made while that loop was running, so the call read before belongs to
  // it.
  std::atomic<std::uint64_t> unclaimed_{0};
  std::atomic<Call> call_{nullptr};
  std::atomic<const void*> context_{nullptr};
  std::atomic<std::uint32_t> claim_{1};
  std::atomic<std::uint32_t> done_{0};
  std::atomic<std::uint32_t> bell_{0};  // rung for every loop, and at the end
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_;
};

}  // namespace clearance
