#include "monitor/pairs/worker_pool.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr int kSpins = 2'000;  // about 50 us: the gaps between the loops of a tick

constexpr std::uint64_t kLoop = std::uint64_t{1} << 32;

std::uint32_t indices(std::uint64_t unclaimed) noexcept {
  return static_cast<std::uint32_t>(unclaimed);
}

void pause() noexcept {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

WorkerPool::WorkerPool(unsigned workers, const std::function<void()>& on_start) {
  for (unsigned i = 1; i < workers; ++i) {
    threads_.emplace_back([this, on_start] {
      if (on_start) on_start();
      serve();
    });
  }
}

WorkerPool::~WorkerPool() {
  stop_ = true;
  ++bell_;
  bell_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void WorkerPool::run(std::uint32_t count, Share share, Call call, const void* context) noexcept {
  if (threads_.empty() || count < share.least) {
    for (std::uint32_t i = 0; i < count; ++i) call(context, i);
    return;
  }
  call_.store(call, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  claim_.store(share.claim, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  const std::uint64_t last = unclaimed_.load(std::memory_order_relaxed);
  unclaimed_.store(last - indices(last) + kLoop + count, std::memory_order_release);
  bell_.fetch_add(1, std::memory_order_release);
  bell_.notify_all();
  while (help()) {
  }
  wait_until_done(count);
}

// Does some of the loop that is running; false: nothing of it is left to claim.
bool WorkerPool::help() noexcept {
  std::uint64_t unclaimed = unclaimed_.load(std::memory_order_acquire);
  while (indices(unclaimed) > 0) {
    const Call call = call_.load(std::memory_order_relaxed);
    const void* const context = context_.load(std::memory_order_relaxed);
    const std::uint32_t taken =
        std::min(claim_.load(std::memory_order_relaxed), indices(unclaimed));
    if (!unclaimed_.compare_exchange_weak(unclaimed, unclaimed - taken, std::memory_order_acq_rel,
                                          std::memory_order_acquire)) {
      continue;
    }
    const std::uint32_t first = indices(unclaimed) - taken;
    for (std::uint32_t i = first; i < first + taken; ++i) call(context, i);
    done_.fetch_add(taken, std::memory_order_release);
    done_.notify_one();
    return true;
  }
  return false;
}

// Others may be at work on what they claimed, or may have been interrupted there.
void WorkerPool::wait_until_done(std::uint32_t count) noexcept {
  for (int spin = 0; spin < kSpins; ++spin) {
    if (done_.load(std::memory_order_acquire) == count) return;
    pause();
  }
  for (std::uint32_t done; (done = done_.load(std::memory_order_acquire)) != count;) {
    done_.wait(done, std::memory_order_acquire);
  }
}

void WorkerPool::serve() noexcept {
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::uint32_t bell = bell_.load(std::memory_order_acquire);
    while (help()) {
    }
    int spin = 0;
    while (spin < kSpins && bell_.load(std::memory_order_relaxed) == bell) {
      pause();
      ++spin;
    }
    if (spin == kSpins && !stop_.load(std::memory_order_relaxed)) {
      bell_.wait(bell, std::memory_order_acquire);
    }
  }
}

}  // namespace clearance
