// The messages for a service manager, read from a socket of the test.
#include "monitor/daemon/service_manager.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>

#include "tests/shared/notify_socket.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::Optional;
using testing::StartsWith;

constexpr std::chrono::milliseconds kAtOnce{0};

class ServiceManagerMessages : public testing::Test {
 protected:
  ServiceManagerMessages() { setenv("NOTIFY_SOCKET", socket.path().c_str(), 1); }
  ~ServiceManagerMessages() override {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
  }
  // With this interval every new cycle feeds the watchdog.
  static void watch(const char* interval_us = "1") { setenv("WATCHDOG_USEC", interval_us, 1); }

  test::NotifySocket socket;
};

TEST_F(ServiceManagerMessages, ItIsReadyWithTheFirstPublishedReportAndOnce) {
  ServiceManager service("cell 'bench'");
  service.notice(0);
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt);
  service.notice(3);
  EXPECT_THAT(socket.next(kAtOnce), Optional(StartsWith("READY=1\nSTATUS=cell 'bench'")));
  service.notice(4);
  service.notice(5);
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt) << "there is no watchdog";
}

TEST_F(ServiceManagerMessages, TheWatchdogIsFedByAdvancingCyclesOnly) {
  watch();
  ServiceManager service("cell");
  for (const std::uint64_t none : {0, 0, 0}) service.notice(none);
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt);
  service.notice(1);
  EXPECT_THAT(socket.next(kAtOnce), Optional(HasSubstr("READY=1")));
  EXPECT_EQ(socket.next(kAtOnce), "WATCHDOG=1");
  for (const std::uint64_t same : {1, 1, 1}) service.notice(same);
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt);
  service.notice(2);
  EXPECT_EQ(socket.next(kAtOnce), "WATCHDOG=1");
}

TEST_F(ServiceManagerMessages, TheWatchdogIsFedSeldomWithinItsInterval) {
  watch("3600000000");
  ServiceManager service("cell");
  service.notice(1);
  EXPECT_THAT(socket.next(kAtOnce), Optional(HasSubstr("READY=1")));
  EXPECT_EQ(socket.next(kAtOnce), "WATCHDOG=1");
  for (std::uint64_t cycle = 2; cycle < 100; ++cycle) service.notice(cycle);
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt);
}

TEST_F(ServiceManagerMessages, AReloadBeginsWithItsTimeAndEndsWithItsOutcome) {
  const auto now_us = [] {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000 +
           static_cast<std::uint64_t>(now.tv_nsec) / 1'000;
  };
  const ServiceManager service("cell");
  const std::uint64_t before = now_us();
  service.reloading();
  const std::string begun = socket.next(kAtOnce).value_or("");
  const std::string prefix = "RELOADING=1\nMONOTONIC_USEC=";
  ASSERT_THAT(begun, StartsWith(prefix));
  const std::uint64_t told = std::stoull(begun.substr(prefix.size()));
  EXPECT_LE(before, told);
  EXPECT_LE(told, now_us());
  service.reloaded("refused\nREADY=0");
  const std::string ended = socket.next(kAtOnce).value_or("");
  EXPECT_THAT(ended, StartsWith("READY=1\nSTATUS=cell; refused"));
  EXPECT_THAT(ended, Not(HasSubstr("\nREADY=0"))) << "a text cannot forge a variable";
}

TEST_F(ServiceManagerMessages, NothingFailsWithoutAServiceManager) {
  unsetenv("NOTIFY_SOCKET");
  ServiceManager service("cell");
  service.notice(1);
  service.reloading();
  service.reloaded("done");
  service.stopping();
  EXPECT_EQ(socket.next(kAtOnce), std::nullopt);
}

}  // namespace
}  // namespace clearance
