#include "config/mesh/child_work.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <vector>

namespace clearance {
namespace {

using testing::HasSubstr;

TEST(ChildWork, GivesTheBytesOfTheWork) {
  const std::string bytes(1'000'000, 'x');
  EXPECT_EQ(bytes, in_child([&] { return bytes; }).bytes);
  const ChildWork nothing = in_child([] { return std::string(); });
  EXPECT_EQ("", nothing.bytes);
  EXPECT_EQ("", nothing.fault);
}

TEST(ChildWork, ACrashIsAFault) {
  const ChildWork work = in_child([]() -> std::string {
    std::raise(SIGSEGV);
    return "not reached";
  });
  EXPECT_EQ("crashed (Segmentation fault)", work.fault);
  EXPECT_EQ("", work.bytes);
}

TEST(ChildWork, AnExceptionIsAFault) {
  EXPECT_NE("", in_child([]() -> std::string { throw std::runtime_error("x"); }).fault);
}

TEST(ChildWork, WorkWithoutEndIsEnded) {
  volatile bool forever = true;
  const ChildWork busy = in_child(
      [&] {
        while (forever) {
        }
        return std::string();
      },
      {.cpu_s = 1});
  EXPECT_EQ("took more than 1 s of processor time", busy.fault);
  const ChildWork waiting = in_child(
      [] {
        pause();
        return std::string();
      },
      {.wall_s = 1});
  EXPECT_EQ("took longer than 1 s", waiting.fault);
}

// Sanitizers map more memory themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(ChildWork, WorkThatTakesTooMuchMemoryIsEnded) {
  const ChildWork work = in_child([] { return std::string(std::size_t{200} << 20, 'x'); },
                                  {.memory = std::size_t{100} << 20});
  EXPECT_EQ("needed more than 100 MiB of memory", work.fault);
}
#endif

}  // namespace
}  // namespace clearance
