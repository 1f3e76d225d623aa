// Requests of clients that wait until a thread handles them: in order, and never too many.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "monitor/interface/mutex.hpp"

namespace clearance {

// Any thread but that of the tick. `Item` has a function bytes_of(const Item&), for the memory that
// it takes while it waits.
template <class Item>
class RequestQueue {
 public:
  // The number of requests that may wait, and their bytes. One request may always wait, however
  // large it is.
  RequestQueue(std::size_t most, std::size_t most_bytes) : most_(most), most_bytes_(most_bytes) {}

  // Returns false, and drops it, if too much waits, or after close().
  [[nodiscard]] bool put(Item item) {
    const std::size_t bytes = bytes_of(item);
    {
      const Lock lock(mutex_);
      const bool is_full =
          !waiting_.empty() && (waiting_.size() >= most_ || bytes_ + bytes > most_bytes_);
      if (closed_ || is_full) return false;
      bytes_ += bytes;
      waiting_.push_back(std::move(item));
    }
    changed_.notify_one();
    return true;
  }
  // Waits for a request. Returns nothing after close().
  [[nodiscard]] std::optional<Item> next() {
    Lock lock(mutex_);
    changed_.wait(lock, [this]() REQUIRES(mutex_) { return closed_ || !waiting_.empty(); });
    if (closed_) return std::nullopt;
    return take_first();
  }
  // The same, but returns nothing after this time, too.
  [[nodiscard]] std::optional<Item> next_within(std::chrono::milliseconds patience) {
    Lock lock(mutex_);
    changed_.wait_for(lock, patience,
                      [this]() REQUIRES(mutex_) { return closed_ || !waiting_.empty(); });
    return closed_ || waiting_.empty() ? std::nullopt : std::optional(take_first());
  }
  [[nodiscard]] bool is_closed() {
    const Lock lock(mutex_);
    return closed_;
  }
  // Drops the requests that wait.
  void close() {
    {
      const Lock lock(mutex_);
      closed_ = true;
      waiting_.clear();
      bytes_ = 0;
    }
    changed_.notify_all();
  }

 private:
  Item take_first() REQUIRES(mutex_) {
    Item item = std::move(waiting_.front());
    waiting_.pop_front();
    bytes_ -= bytes_of(item);
    return item;
  }

  const std::size_t most_, most_bytes_;
  Mutex mutex_;
  std::condition_variable changed_;
  GUARDED_BY(mutex_) std::deque<Item> waiting_;
  GUARDED_BY(mutex_) std::size_t bytes_ = 0;
  GUARDED_BY(mutex_) bool closed_ = false;
};

}  // namespace clearance
