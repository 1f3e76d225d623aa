// The shares of a cell as daemons, one process each, and a robot that sends the poses of the boxes.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/client/shared_cell.hpp"
#include "monitor/interface/report.hpp"
#include "tests/tools/meeting_boxes.hpp"

namespace clearance::test {

inline const std::string kMerge = places::programs() + "/clearance-merge";

// The two boxes form one share. Each box with the floor forms another.
inline std::string shared_cell(const std::string& more = {}) {
  return meeting_cell() +
         R"(shares:
  - {name: boxes, pairs: [{between: [arm, arm]}]}
  - {name: left floor, pairs: [{between: [left, floor]}]}
  - {name: right floor, pairs: [{between: [right, floor]}]}
)" + more;
}

class SharedCells : public testing::Test {
 protected:
  explicit SharedCells(const std::string& more = {}) : SharedCells(CellText{shared_cell(more)}) {}
  struct CellText {
    std::string text;
  };
  explicit SharedCells(const CellText& of) : file(of.text) {}

  DdsOptions dds = own_dds();
  CellFile file;
  Cell cell = file.cell();
  SendingRobot robot{dds, cell};
  client::Connection connection{dds, cell.topics};
  std::map<std::string, std::unique_ptr<ChildProcess>> daemons;

  ChildProcess& start(const std::string& share, const std::vector<std::string>& more = {},
                      const std::string& as = {}) {
    auto& daemon = daemons[as.empty() ? share : as];
    daemon = std::make_unique<ChildProcess>(
        kDaemon, with(with({file.path(), "--share", share}, dds_arguments(dds)), more));
    return *daemon;
  }
  void start_all() {
    for (const Share& share : cell.shares.all) start(share.name);
  }
  std::string logs() {
    std::string text;
    for (const auto& [name, daemon] : daemons) text += "== " + name + "\n" + daemon->output();
    return text;
  }
  template <class IsSo>
  static bool read_until(client::SharedCell& whole, const IsSo& is_so, int seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (whole.next(std::chrono::milliseconds(100)) && is_so()) return true;
    }
    return false;
  }
  static std::uint8_t status(const client::SharedCell& whole, std::uint32_t pair) {
    for (std::uint32_t i = 0; i < whole->pairs._length; ++i) {
      if (whole->pairs._buffer[i].pair == pair) return whole->pairs._buffer[i].status;
    }
    return 255;
  }
};
inline constexpr auto kUnknown = static_cast<std::uint8_t>(PairStatus::kUnknown);

}  // namespace clearance::test
