// Two boxes that meet again and again, and a robot that sends their poses.
#pragma once

#include <dds/dds.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>

#include "tests/tools/running_cell.hpp"

namespace clearance::test {

// Sends poses in a thread of its own, as a robot does.
class SendingRobot {
 public:
  SendingRobot(const DdsOptions& dds, const Cell& cell)
      : participant_(dds), poses_(participant_, cell) {
    thread_ = std::thread([this] {
      const std::int64_t began = dds_time();
      while (!stop_) {
        poses_.send(1e-9 * static_cast<double>(dds_time() - began));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  ~SendingRobot() {
    stop_ = true;
    thread_.join();
  }

 private:
  Participant participant_;
  Poses poses_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

// The two boxes come so near to each other, again and again, that the zone is active for a while.
inline std::string meeting_cell() {
  std::string text = small_cell("pair");
  const std::string apart = "[0.1, 0.2, 0]";
  return text.replace(text.find(apart), apart.size(), "[0.35, 0, 0]");
}

}  // namespace clearance::test
