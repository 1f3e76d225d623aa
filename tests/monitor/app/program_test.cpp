// The reaction of every program to the signals that stop it.
#include "monitor/app/program.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace clearance {
namespace {

TEST(RunProgram, KeepsASignalThatComesAtOnceUntilTheBodyAsks) {
  const auto body = [](StopSignal& signal) {
    std::raise(SIGTERM);
    return signal.wait(0) ? kOk : kFailed;
  };
  EXPECT_EXIT(std::_Exit(run_program("told-to-stop", body)), testing::ExitedWithCode(kOk), "");
}

TEST(RunProgram, EndsWithAStatusOfItsOwnWhereThatTellsSomething) {
  for (const bool early : {false, true}) {
    const auto body = [early](StopSignal& signal) {
      if (early) std::raise(SIGTERM);
      signal.end_with(kFailed, "stopped half way\n");
      std::raise(SIGTERM);
      return kOk;
    };
    EXPECT_EXIT(std::_Exit(run_program("interrupted", body)), testing::ExitedWithCode(kFailed),
                "stopped half way");
  }
}

TEST(RunProgram, SaysWhatWasThrownAndFails) {
  const auto body = [](StopSignal&) -> int { throw std::runtime_error("no cell today"); };
  EXPECT_EXIT(std::_Exit(run_program("unlucky", body)), testing::ExitedWithCode(kFailed),
              "unlucky: no cell today");
}

}  // namespace
}  // namespace clearance
