// A daemon that a test feeds and watches: the last report and the log.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {

class WatchedDaemon : public testing::Test {
 protected:
  // Starts the daemon on a cell with this text, in the folder of scara.urdf.
  void watch(const std::string& text, const std::vector<std::string>& more = {}) {
    write_text(folder / "scara.urdf", kScaraUrdf);
    cell = folder / "cell.yaml";
    write_text(cell, text);
    read = std::get<Cell>(read_cell(cell));
    distances.emplace(client, read);
    daemon.emplace(kDaemon, with(with({cell}, dds_arguments(dds)), more),
                   ChildOptions{.environment = more_environment});
    distances->settle();
  }

  // Calls `step` every `period_ms` until `is_so` is true or the time is over.
  template <class Step, class IsSo>
  bool step_until(int period_ms, const Step& step, const IsSo& is_so, int seconds = 20) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(seconds);
    while (std::chrono::steady_clock::now() < end) {
      step();
      std::this_thread::sleep_for(std::chrono::milliseconds(period_ms));
      take();
      if (is_so()) return true;
    }
    return false;
  }
  auto told(const std::string& code, const std::vector<std::string>& names = {}) {
    return [this, code, names] { return daemon->told(code, names); };
  }
  void take() {
    while (take_next(distances->reader(), report)) {
    }
  }
  // The pair in the last report; nothing is known of it before the first one.
  const clearance_msg_PairDistance& pair(const std::string& link) const {
    if (report->pairs._length == 0) return unknown_;
    std::uint32_t place = 0;  // index in the report, which contains only published pairs
    for (const ObjectPair& of : scene.pairs) {
      if (!of.publish) continue;
      if (scene.objects[of.first].name == link || scene.objects[of.second].name == link)
        return report->pairs._buffer[place];
      ++place;
    }
    ADD_FAILURE() << "no pair of " << link;
    return report->minimum;
  }
  bool is(const std::string& link, PairStatus status) const {
    return report->pairs._length > 0 && pair(link).status == static_cast<std::uint8_t>(status);
  }

  ScratchFolder folder;
  std::vector<std::pair<std::string, std::string>> more_environment;  // of the daemon
  std::filesystem::path cell;
  Cell read;
  Scene& scene = read.scene;
  DdsOptions dds = own_dds();
  Participant client{dds};
  std::optional<Distances> distances;
  Sample<clearance_msg_Distances> report;
  std::optional<ChildProcess> daemon;

 private:
  clearance_msg_PairDistance unknown_ = [] {
    clearance_msg_PairDistance pair{};
    pair.status = static_cast<std::uint8_t>(PairStatus::kUnknown);
    pair.lower = -kInfinity;
    pair.upper = kInfinity;
    return pair;
  }();
};

}  // namespace clearance::test
