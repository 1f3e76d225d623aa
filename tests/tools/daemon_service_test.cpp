// clearanced as a service: what it tells a service manager, and that it works under the limits of a
// unit. Ticks are made to stand still by stopping their thread as a debugger does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>

#include "tests/shared/notify_socket.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;
using testing::Optional;
using testing::StartsWith;

// A thread of another process that stands still while this object lives.
class StoppedThread {
 public:
  StoppedThread(pid_t process, const std::string& name) {
    for (const auto& task :
         std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
      std::string its_name;
      std::getline(std::ifstream(task.path() / "comm"), its_name);
      if (its_name == name) thread_ = std::stoi(task.path().filename());
    }
    stopped_ = thread_ > 0 && ptrace(PTRACE_SEIZE, thread_, nullptr, nullptr) == 0 &&
               ptrace(PTRACE_INTERRUPT, thread_, nullptr, nullptr) == 0 &&
               waitpid(thread_, nullptr, __WALL) == thread_;
  }
  ~StoppedThread() {
    if (stopped_) ptrace(PTRACE_DETACH, thread_, nullptr, nullptr);
  }
  StoppedThread(const StoppedThread&) = delete;
  StoppedThread& operator=(const StoppedThread&) = delete;
  [[nodiscard]] bool stopped() const noexcept { return stopped_; }

 private:
  pid_t thread_ = -1;
  bool stopped_ = false;
};

class DaemonAsAService : public testing::Test {
 protected:
  // 40 ms: the daemon feeds the watchdog each time it looks.
  void start() {
    const ChildOptions options{
        .environment = {{"NOTIFY_SOCKET", socket.path()}, {"WATCHDOG_USEC", "40000"}}};
    daemon.emplace(kDaemon, with({cell.path()}, dds_arguments(own_dds())), options);
  }

  NotifySocket socket;
  CellFile cell{small_cell("service")};
  std::optional<ChildProcess> daemon;
};

TEST_F(DaemonAsAService, IsReadyFeedsTheWatchdogAndSaysThatItStops) {
  start();
  EXPECT_THAT(socket.next(), Optional(StartsWith("READY=1\nSTATUS=cell 'service'")));
  for (int i = 0; i < 5; ++i) EXPECT_EQ(socket.next(), "WATCHDOG=1");
  daemon->signal(SIGTERM);
  EXPECT_TRUE(socket.until("STOPPING=1"));
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
}

TEST_F(DaemonAsAService, DoesNotFeedTheWatchdogWhileTicksStandStill) {
  start();
  ASSERT_TRUE(socket.until("WATCHDOG=1"));
  {
    const StoppedThread ticks(daemon->pid(), "tick");
    if (!ticks.stopped()) GTEST_SKIP() << "this system does not let a test stop a thread";
    // Each answer shows that the thread that feeds the watchdog has looked at the ticks again. The
    // first rounds may still see reports that were queued.
    int hungry = 0;
    for (int round = 0; round < 60 && hungry < 12; ++round) {
      daemon->signal(SIGHUP);
      for (++hungry;;) {
        const auto message = socket.next();
        ASSERT_TRUE(message) << daemon->output();
        if (message->starts_with("RELOADING=1")) break;
        if (message == "WATCHDOG=1") hungry = 0;
      }
    }
    EXPECT_EQ(hungry, 12) << "rounds without food";
  }
  EXPECT_TRUE(socket.until("WATCHDOG=1")) << "ticks go on";
}

TEST_F(DaemonAsAService, SaysWhenAReloadBeginsAndWhatCameOfIt) {
  start();
  ASSERT_TRUE(socket.until("READY=1"));
  const auto reload = [this] {
    daemon->signal(SIGHUP);
    EXPECT_THAT(socket.until("RELOADING=1"), Optional(HasSubstr("\nMONOTONIC_USEC=")));
    return socket.until("READY=1");
  };
  const auto unchanged = reload();
  std::string text = small_cell("service");
  text.replace(text.find("offset: 0"), 9, "offset: -1");
  std::ofstream(cell.path()) << text;
  const auto changed = reload();
  std::ofstream(cell.path()) << "name: [";
  const auto refused = reload();
  ASSERT_TRUE(unchanged && changed && refused) << daemon->output();
  EXPECT_NE(unchanged, changed);
  EXPECT_NE(changed, refused);
  EXPECT_NE(unchanged, refused);
  EXPECT_TRUE(daemon->tells("scene-changed"));
  EXPECT_TRUE(daemon->tells("scene-refused"));
}

// Preparing this cell takes several times the limit of real-time processor time: that work must be
// done before SCHED_FIFO is set. A tick takes a tenth of it, so that a slow machine keeps it, too.
TEST(DaemonUnderLimits, PreparesALargeCellAndTicksUnderAFiniteLimitOfRealtime) {
  const ScratchFolder folder;
  const std::string cell = (folder / "warehouse.yaml").string();
  ChildProcess scene(places::programs() + "/clearance-scene", {"warehouse", "2000", "-o", cell});
  ASSERT_EQ(scene.wait(), 0) << scene.output();
  ChildProcess daemon("/usr/bin/prlimit", with({"--rttime=100000:200000", "--", kDaemon, cell,
                                                "--priority", "20", "--ticks", "500"},
                                               dds_arguments(own_dds())));
  const int status = daemon.wait();
  if (daemon.told("system-refuses")) GTEST_SKIP() << "SCHED_FIFO is not allowed here";
  EXPECT_EQ(status, 0) << daemon.output();
}

}  // namespace
}  // namespace clearance::test
