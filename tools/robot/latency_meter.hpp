// How soon the daemon's answer to what a robot sends is back.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "monitor/app/print.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/loop/histogram.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/realtime.hpp"
#include "monitor/loop/summary.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// Measures the age of the newest pose when the first report that used it arrived here.
class LatencyMeter {
 public:
  LatencyMeter(Participant& participant, const std::string& topic)
      : reader_(participant.reader(TopicKind::kDistances, topic)),
        wait_(participant, {reader_}),
        thread_([this] { run(); }) {}
  ~LatencyMeter() {
    stop_ = true;
    wait_.wake();
    thread_.join();
  }

  // `where`: the domain in which reports were awaited.
  void tell(const std::string& where) {
    const std::lock_guard lock(mutex_);
    if (all_.count() == 0) {
      print(stdout, "latency  not known: no report came on {}; does clearanced run there?\n",
            where);
      return;
    }
    print(stdout, "latency  {}  pose sent to report received, {} poses\n", percentiles(all_),
          all_.count());
    print(stdout, "         {}  of which: pose sent to tick\n", percentiles(to_tick_));
    print(stdout, "         {}  of which: tick to report received\n", percentiles(from_tick_));
  }

 private:
  void run() {
    name_thread("latency");
    while (!stop_) {
      if (wait_.wait(DDS_INFINITY)) take_all();
    }
  }

  void take_all() {
    dds_sample_info_t info;
    void* sample = &*sample_;
    while (dds_take(reader_, &sample, &info, 1, 1) > 0) {
      const std::int64_t now = clock_.realtime_ns();
      if (!info.valid_data || sample_->newest_pose_ns <= newest_) continue;
      newest_ = sample_->newest_pose_ns;
      const std::lock_guard lock(mutex_);
      all_.add(now - newest_);
      to_tick_.add(sample_->now_ns - newest_);
      from_tick_.add(now - sample_->now_ns);
    }
  }

  SystemClock clock_;
  dds_entity_t reader_;
  DataWait wait_;
  Sample<clearance_msg_Distances> sample_;
  std::int64_t newest_ = 0;
  std::mutex mutex_;
  Histogram all_, to_tick_, from_tick_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
