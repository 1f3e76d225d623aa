// Two daemons that are partners, as processes, and a client that reads their merged stream.
//
// Another rate in Hz: CLEARANCE_KILLS_RATE=1000
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "tests/tools/meeting_boxes.hpp"
#include "tests/tools/one_leader.hpp"

namespace clearance::test {

using client::PartnerState;

inline std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

inline std::string cell_at_rate() {
  std::string text = meeting_cell();
  const std::string rate = "rate_hz: 200";
  return text.replace(text.find(rate), rate.size(),
                      "rate_hz: " + std::to_string(number_of("CLEARANCE_KILLS_RATE", 50)));
}

class Partners : public ::testing::Test {
 protected:
  explicit Partners(const std::string& text = cell_at_rate()) : file(text) {}

  DdsOptions dds = own_dds();
  CellFile file;
  Cell cell = file.cell();
  SendingRobot robot{dds, cell};
  client::Connection connection{dds, cell.topics};
  OneLeader leaders{connection.participant(), cell};  // of daemons with `--gradients`
  // Both partners at 1 kHz write two thousand reports a second, and the start of a process takes
  // this one some milliseconds.
  client::Reports reports{connection, {.depth = 1024}};
  client::Catalogue catalogue{connection};
  client::Pair boxes{catalogue, "left", "right"};
  std::map<std::string, std::unique_ptr<ChildProcess>> daemons;
  std::uint64_t cycle = 0, last = 0, lineage = 0, came = 0, again = 0;

  ChildProcess& start(const std::string& name, const std::vector<std::string>& more = {}) {
    if (daemons.contains(name))
      logs_before += "== before, " + name + "\n" + daemons[name]->output();
    daemons[name] = std::make_unique<ChildProcess>(
        kDaemon, with(with({file.path()}, dds_arguments(dds)), with({"--partner", name}, more)));
    return *daemons[name];
  }
  void TearDown() override {
    leaders.check();
    const bool judges_lost = cell.scene.rate_hz <= 200.0 && !count_apart;
    // Daemons tell of late ticks once per second.
    if (lost != 0 && judges_lost) read_until([this] { return ran_over(); }, 2);
    EXPECT_TRUE(lost == 0 || !judges_lost || ran_over())
        << lost << " cycles are missing" << losses << logs();
  }
  // Has a daemon told that a tick ended too late? The machine was busy then.
  bool ran_over() { return logs().find("[overruns]") != std::string::npos; }
  // Reads on until this is so. No cycle may be missing. One may come again only from a partner that
  // had other inputs when it was left alone.
  template <class IsSo>
  bool read_until(const IsSo& is_so, int seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (reports.next(std::chrono::milliseconds(100))) note();
      leaders.take();
      if (is_so()) return true;
    }
    return false;
  }
  void note() {
    const clearance_msg_PairDistance* const pair = boxes.in(*reports);
    if (pair != nullptr && pair->swept_lower < 0.3) inside = true;
    if (pair != nullptr && pair->swept_lower > 0.35) inside = false;
    // Every report has its zone, whoever published it.
    if (pair != nullptr && (pair->swept_lower < 0.3 || pair->swept_lower > 0.35)) {
      EXPECT_EQ(reports->active_zones._length > 0, inside) << "at cycle " << reports->cycle;
    }
    if (pair != nullptr && (pair->swept_lower < 0.3) != was_inside) {
      was_inside = !was_inside;
      ++zone_changes;
    }
    // Partners that were alone for a moment count alike if the machine keeps the rate.
    if (reports->lineage == lineage || cycle == 0) {
      EXPECT_EQ(reports.check().missed, 0u) << "cycles are missing";
    } else {
      lost += reports.check().missed;
      if (reports.check().missed != 0) {
        losses +=
            "\n" + std::string(reports->partner) + ": cycle " + std::to_string(cycle) + " to " +
            std::to_string(reports->cycle) + " in " +
            std::to_string(1e-6 * static_cast<double>(reports->now_ns - now_ns)) + " ms, written " +
            std::to_string(1e-6 * static_cast<double>(reports->publish_ns - reports->now_ns)) +
            " ms later\n";
      }
    }
    longest_ns = std::max(longest_ns, cycle == 0 ? 0 : reports->now_ns - now_ns);
    now_ns = reports->now_ns;
    if (reports->cycle <= last) {
      EXPECT_NE(reports->lineage, lineage) << "a cycle came again";
    }
    again += static_cast<std::uint64_t>(reports->cycle <= cycle);
    last = reports->cycle;
    lineage = reports->lineage;
    cycle = std::max(cycle, reports->cycle);
    ++came;
    states[reports.partner().state]++;
  }
  bool agree() {
    states.clear();
    return read_until([this] { return states[PartnerState::kAgrees] > 20; });
  }
  std::string logs() {
    std::string text = logs_before;
    for (const auto& [name, daemon] : daemons) text += "== " + name + "\n" + daemon->output();
    return text;
  }

  std::map<PartnerState, int> states;
  std::uint64_t lost = 0;
  std::string losses,
      logs_before;  // what was lost and when; the logs of daemons that were started again
  bool count_apart =
      false;  // a change of the cell parts them, and a busy machine may tick late then
  std::int64_t now_ns = 0, longest_ns = 0;  // of the last report; between two reports
  bool inside = false, was_inside = false;  // the zone by the reports that came
  int zone_changes = 0;
};

}  // namespace clearance::test
