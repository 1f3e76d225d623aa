// Signals that stop no daemon: hangups, closed terminals, and those that mean nothing to it. Other
// programs end properly.
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>

#include "monitor/files/reader.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;

// A program in a terminal of its own, which can be closed.
class InTerminal {
 public:
  InTerminal(const std::string& program, const std::vector<std::string>& arguments) {
    std::vector<char*> list{const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments)
      list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    pid_ = forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ == 0) {
      execv(program.c_str(), list.data());
      _exit(127);
    }
  }
  ~InTerminal() {
    close_terminal();
    if (pid_ <= 0) return;
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  InTerminal(const InTerminal&) = delete;
  InTerminal& operator=(const InTerminal&) = delete;

  [[nodiscard]] bool shows(const std::string& text) {
    return eventually([&] {
      std::array<char, 4096> piece;
      pollfd readable{.fd = terminal_, .events = POLLIN, .revents = 0};
      if (poll(&readable, 1, 10) > 0) {
        const ssize_t count = read(terminal_, piece.data(), piece.size());
        if (count > 0) shown_.append(piece.data(), static_cast<std::size_t>(count));
      }
      return shown_.find(text) != std::string::npos;
    });
  }
  void close_terminal() {
    if (terminal_ >= 0) close(terminal_);
    terminal_ = -1;
  }
  void signal(int number) const { kill(pid_, number); }
  // Returns the exit status, or -1 if a signal ended the program or it still runs.
  int wait() {
    int status = 0;
    const bool ended = eventually([&] { return waitpid(pid_, &status, WNOHANG) == pid_; });
    if (!ended) return -1;
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  int terminal_ = -1;
  pid_t pid_ = -1;
  std::string shown_;
};

// Reads the reports that wait, then waits for another one.
bool still_reports(test::Distances& distances) {
  for (int i = 0; i < 100; ++i) {
    if (distances.next() == nullptr) return false;
  }
  return true;
}

class Signals : public test::RunsPrograms {
 protected:
  test::CellFile cell{test::small_cell("signals")};
  Cell read = cell.cell();
  DdsOptions dds = test::own_dds();
  Participant client{dds};
  test::Distances distances{client, read};
  std::vector<std::string> arguments =
      test::with({cell.path(), "--record", path("run.mcap")}, test::dds_arguments(dds));
};

TEST_F(Signals, ThatMeanNothingEndNoDaemonAndAHangupReadsTheCellAgain) {
  ChildProcess daemon(test::kDaemon, arguments);
  distances.settle();
  for (const int number : {SIGUSR1, SIGUSR2, SIGALRM, SIGHUP}) daemon.signal(number);
  EXPECT_TRUE(daemon.tells("scene-unchanged")) << daemon.output();
  EXPECT_TRUE(still_reports(distances));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  EXPECT_EQ(run(test::kReplay, {"check", path("run.mcap")}), 0) << output;
}

TEST_F(Signals, OfAClosedTerminalEndNoDaemon) {
  InTerminal daemon(test::kDaemon, arguments);
  ASSERT_TRUE(daemon.shows("[started]"));
  distances.settle();
  daemon.close_terminal();
  EXPECT_TRUE(still_reports(distances));
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_EQ(run(test::kReplay, {"check", path("run.mcap")}), 0) << output;
}

TEST_F(Signals, OfAClosedTerminalEndARecordingProperly) {
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, test::dds_arguments(dds)));
  InTerminal recorder(test::kRecord,
                      test::with({"-o", path("seen.mcap")}, test::dds_arguments(dds)));
  distances.settle();
  std::error_code fault;
  EXPECT_TRUE(eventually(
      [&] { return std::filesystem::file_size(path("seen.mcap"), fault) > 50'000 && !fault; }));
  recorder.close_terminal();
  EXPECT_EQ(recorder.wait(), 0);
  McapReader reader(path("seen.mcap"));
  McapMessage message;
  while (reader.next(message)) continue;
  EXPECT_EQ(reader.error(), "");
  EXPECT_GT(reader.messages(), 0u);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

}  // namespace
}  // namespace clearance
