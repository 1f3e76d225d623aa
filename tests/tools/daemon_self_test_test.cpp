// A bit that flips in the memory of a daemon that runs: another process writes there.
#include <gtest/gtest.h>
#include <sys/uio.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

// A size that no other number of the process has.
constexpr double kSize = 0.24680135791113, kHalf = 0.5 * kSize;

// Flips the last bit of each such double on the heap. Returns how many there were. Nothing can be
// written to /proc/PID/mem where /proc is read-only, as in the roots of mmdebstrap.
std::size_t flip_all(pid_t process, double value) {
  std::ifstream maps("/proc/" + std::to_string(process) + "/maps");
  std::size_t count = 0;
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t begin = 0, end = 0;
    std::array<char, 5> rights{};
    if (std::sscanf(line.c_str(), "%lx-%lx %4s", &begin, &end, rights.data()) != 3) continue;
    const bool is_anonymous = line.find(" 0 ") != line.npos && line.find("[stack") == line.npos;
    if (std::strncmp(rights.data(), "rw", 2) != 0 || !is_anonymous) continue;
    std::vector<double> words((end - begin) / sizeof(double));
    const iovec here{words.data(), end - begin};
    const iovec there{reinterpret_cast<void*>(begin), end - begin};
    if (process_vm_readv(process, &here, 1, &there, 1, 0) <= 0) continue;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] != value) continue;
      std::uint64_t bits = 0;
      std::memcpy(&bits, &words[i], sizeof bits);
      bits ^= 1;
      const iovec changed{&bits, sizeof bits};
      const iovec at{reinterpret_cast<void*>(begin + i * sizeof bits), sizeof bits};
      count += process_vm_writev(process, &changed, 1, &at, 1, 0) == sizeof bits ? 1 : 0;
    }
  }
  return count;
}

TEST(DaemonSelfTest, EndsTheDaemonThatNamesTheTableAndPublishesNoReportOfThatTick) {
  std::string text = small_cell("damaged");
  const std::string box = "box: {size: [0.2, 0.3, 0.2]}";
  char sized[64];
  std::snprintf(sized, sizeof sized, "box: {size: [%.17g, 0.3, 0.2]}", kSize);
  text.replace(text.find(box), box.size(), sized);
  const CellFile cell(text);
  const Cell read = cell.cell();
  const DdsOptions dds = own_dds();
  Participant client{dds};
  Distances distances{client, read};
  ChildProcess daemon{kDaemon, with({cell.path()}, dds_arguments(dds))};
  distances.settle();
  ASSERT_TRUE(daemon.tells("self-test"));
  EXPECT_FALSE(daemon.told("self-test-failed"));
  ASSERT_GT(flip_all(daemon.pid(), kHalf), 0u) << "no such number in the daemon's memory";
  EXPECT_EQ(daemon.wait(std::chrono::seconds(20)), 7) << daemon.output();
  EXPECT_TRUE(daemon.tells("self-test-failed", {"the object 'right'"})) << daemon.output();
  EXPECT_TRUE(eventually([&] {
    dds_liveliness_changed_status_t status{};
    dds_get_liveliness_changed_status(distances.reader(), &status);
    return status.alive_count == 0;
  }));
}

}  // namespace
}  // namespace clearance::test
