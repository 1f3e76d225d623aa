// A recorded run of the bench cell, to be replayed without DDS.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "monitor/replay/offline_replay.hpp"
#include "tests/monitor/replay/recorded_runs.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {

class OfflineReplayTest : public testing::Test {
 protected:
  ScratchFolder folder;
  Cell cell{bench_cell()};
  Scene& scene = cell.scene;
  std::filesystem::path run = folder / "run.mcap";

  OfflineReplay replay(const OfflineReplayOptions& options = {}) {
    return replay_offline(cell, run, options);
  }
  // Writes the run again after a change of the whole list of messages.
  void rewrite(const std::function<void(std::vector<Kept>&)>& change) {
    std::vector<Kept> messages = messages_of(run);
    change(messages);
    write_messages(run, messages);
  }
  // The place of a tick's report. Ticks count from 1.
  static std::size_t report_of(const std::vector<Kept>& messages, int tick) {
    std::size_t place = 0;
    for (; place < messages.size(); ++place) {
      if (messages[place].kind == TopicKind::kDistances && --tick == 0) break;
    }
    return place;
  }
};

}  // namespace clearance::test
