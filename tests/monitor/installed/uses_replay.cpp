// The example in the README under "In your tests". The hand comes as near as 0.3 m, so an
// expectation of 0.25 m holds and one of 0.35 m does not.
#include <config/cell/cell_file.hpp>
#include <monitor/replay/offline_replay.hpp>

#include <cstdio>

int main(int, char** argv) {
  const clearance::CellResult cell = clearance::read_cell(argv[1]);
  const auto& read = std::get<clearance::Cell>(cell);
  const clearance::OfflineReplay held =
      clearance::replay_offline(read, argv[2], {.expect_min_distance = 0.25});
  const clearance::OfflineReplay broken =
      clearance::replay_offline(read, argv[2], {.expect_min_distance = 0.35});
  std::printf("%s%s", held.text().c_str(), broken.text().c_str());
  return held.ok() && held.ticks == 2 && broken.error.empty() && !broken.ok() ? 0 : 1;
}
