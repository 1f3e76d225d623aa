// The latency of the daemon's answer to a robot's poses.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "monitor/app/log_line.hpp"
#include "monitor/app/print.hpp"
#include "monitor/client/client.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"

namespace clearance {

// Measures the age of the newest pose when the first report that used it arrives.
class LatencyMeter {
 public:
  // `priority`: SCHED_FIFO of the thread that receives; 0: none.
  LatencyMeter(client::Connection& connection, int priority)
      : reports_(connection), thread_([this] { run(); }) {
    if (priority > 0) (void)use_fifo_scheduling(priority, thread_.native_handle());
  }
  ~LatencyMeter() {
    stop_ = true;
    thread_.join();
  }

  // `where`: the domain of the reports.
  void tell(const std::string& where) {
    const Lock lock(mutex_);
    if (all_.count() == 0) {
      print(stdout, "latency  not known: no report came on {}; does clearanced run there?\n",
            where);
      return;
    }
    print(stdout, "latency  {}  batch sent to report received, {}\n", percentiles(all_),
          counted(all_.count(), "batch", "batches"));
    print(stdout, "         {}  of which: batch sent to tick\n", percentiles(to_tick_));
    print(stdout, "         {}  of which: tick to report received\n", percentiles(from_tick_));
  }

  [[nodiscard]] std::string histograms() {
    const Lock lock(mutex_);
    return histograms_json({{"sent_to_received", all_}, {"tick_to_received", from_tick_}});
  }

 private:
  void run() {
    name_thread("latency");
    while (!stop_) {
      if (reports_.next(std::chrono::milliseconds(50))) note(clock_.realtime_ns());
    }
  }

  void note(std::int64_t now) {
    if (reports_->newest_pose_ns <= newest_) return;
    newest_ = reports_->newest_pose_ns;
    const Lock lock(mutex_);
    all_.add(now - newest_);
    to_tick_.add(reports_->now_ns - newest_);
    from_tick_.add(now - reports_->now_ns);
  }

  SystemClock clock_;
  client::Reports reports_;
  std::int64_t newest_ = 0;
  Mutex mutex_;
  GUARDED_BY(mutex_) Histogram all_, to_tick_, from_tick_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
