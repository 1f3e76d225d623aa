// No function that logs or prints waits for its reader.
#include "monitor/app/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <sstream>

#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "tests/shared/full_pipe.hpp"

namespace clearance {
namespace {

// Logs a text that spdlog does not know at compile time.
void log(const std::string& text) { spdlog::info("{}", text); }

// Ends the process, as a death test must: with 0 if `is_so`, otherwise with a description of the
// fault.
void end_with(bool is_so, const std::string& otherwise, int errors) {
  if (!is_so) dprintf(errors, "%s", otherwise.c_str());
  std::exit(is_so ? 0 : 1);
}

// Counts lines that contain a number, and the number of lines reported as missing.
struct Counted {
  std::uint64_t here = 0, left_out = 0;
  bool in_order = true;

  explicit Counted(const std::string& text) {
    std::istringstream lines(text);
    std::uint64_t last = 0;
    for (std::string line; std::getline(lines, line);) {
      const std::string said = line.substr(line.find(": ") + 2);
      if (line.find("left out here") != std::string::npos) {
        left_out += std::stoull(said);
        continue;
      }
      ++here;
      in_order = in_order && std::stoull(said) > last;
      last = std::stoull(said);
    }
  }
};

TEST(Log, WaitsForNobodyAndSaysHowManyLinesAreMissing) {
  const auto body = [] {
    const int errors = dup(STDERR_FILENO);
    test::FullPipe pipe;
    dup2(pipe.in(), STDERR_FILENO);
    start_log("flooded", "info");
    constexpr std::uint64_t kLines = 5000;
    for (std::uint64_t i = 1; i <= kLines; ++i) log(std::to_string(i));
    const std::string text = pipe.read(200);
    const Counted counted(text);
    end_with(counted.in_order && counted.left_out > 0 && counted.here >= 1024 &&
                 counted.here + counted.left_out == kLines,
             text, errors);
  };
  EXPECT_EXIT(body(), testing::ExitedWithCode(0), "");
}

TEST(Log, GoesOnWhenItIsReadAgain) {
  const auto body = [] {
    const int errors = dup(STDERR_FILENO);
    test::FullPipe pipe;
    dup2(pipe.in(), STDERR_FILENO);
    start_log("flooded", "info");
    for (int i = 0; i < 5000; ++i) log("flood");
    pipe.read(200);
    log("afterwards");
    drain_log();
    end_with(pipe.read(0).find("afterwards") != std::string::npos, "not there", errors);
  };
  EXPECT_EXIT(body(), testing::ExitedWithCode(0), "");
}

TEST(Log, EndsTheProgramThoughNobodyReadsIt) {
  const auto body = [](StopSignal&) -> int {
    test::FullPipe pipe;
    dup2(pipe.in(), STDERR_FILENO);
    dup2(pipe.in(), STDOUT_FILENO);
    start_log("unread", "info");
    log("a line");
    write_text(stdout, "a summary", Patience::kBrief);
    throw std::runtime_error("an error");
  };
  EXPECT_EXIT(std::exit(run_program("unread", body)), testing::ExitedWithCode(kFailed), "");
}

TEST(Log, IsOneLineOfPrintableTextAnEvent) {
  const auto body = [] {
    start_log("named", "info");
    log("source 'a\nb\x1b[2J\xff\u00e9'");
    std::exit(0);
  };
  EXPECT_EXIT(body(), testing::ExitedWithCode(0),
              testing::HasSubstr("info: source 'a\\x0Ab\\x1B[2J\\xFF\u00e9'\n"));
}

TEST(Print, OfResultsWaitsForItsReaderUntilASignalComes) {
  const auto body = [](StopSignal&) {
    test::FullPipe pipe;
    const int out = dup(STDOUT_FILENO);
    dup2(pipe.in(), STDOUT_FILENO);
    std::raise(SIGTERM);
    print(stdout, "{}", "a result");
    dup2(out, STDOUT_FILENO);
    return pipe.read(0).empty() ? kOk : kFailed;
  };
  EXPECT_EXIT(std::exit(run_program("unread", body)), testing::ExitedWithCode(kOk), "");
}

}  // namespace
}  // namespace clearance
