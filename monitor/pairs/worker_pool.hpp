// Threads that share one loop with the thread of the tick.
//
// The work of each index is done once, by whoever takes it first, and must not depend on that: then
// results are the same bits for any number of workers. No lock and no heap: indices are claimed by
// one atomic word, and who has nothing to do spins for a while and then sleeps on a futex, so that
// a processor fewer than workers costs time and never hangs.
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

  // How a loop is shared: so many indices are claimed at once, and fewer than `least` are left to
  // the caller.
  struct Share {
    std::uint32_t claim, least;
  };

  // Calls work(i) once for each i < count, in no particular order and at the same time, and returns
  // when all are done. `work` is noexcept. One caller at a time.
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

  // Upper half: which loop; lower half: how many indices nobody has claimed. A claim that succeeds
  // was made while that loop was running, so what was read of it before is its own.
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
