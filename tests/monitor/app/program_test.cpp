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

TEST(RunProgram, IsStoppedByAHangupUnlessItKeepsRunning) {
  const auto stopped = [](StopSignal& signal) {
    std::raise(SIGHUP);
    return stop_is_asked_for() && signal.wait(0) ? kOk : kFailed;
  };
  EXPECT_EXIT(std::_Exit(run_program("hung-up", stopped)), testing::ExitedWithCode(kOk), "");

  const auto goes_on = [](StopSignal& signal) {
    signal.keep_running_on_hangup();
    std::raise(SIGHUP);
    const bool went_on = !stop_is_asked_for() && !signal.wait(0) && signal.hung_up() &&
                         !signal.hung_up() && !stop_is_asked_for();
    std::raise(SIGTERM);
    return went_on && signal.wait(0) ? kOk : kFailed;
  };
  EXPECT_EXIT(std::_Exit(run_program("daemon", goes_on)), testing::ExitedWithCode(kOk), "");
}

TEST(RunProgram, DoesNotHearAHangupThatNohupIgnores) {
  const auto body = [](StopSignal& signal) {
    std::raise(SIGHUP);
    return signal.wait(0) ? kFailed : kOk;
  };
  const auto run = [&] {
    std::signal(SIGHUP, SIG_IGN);
    std::_Exit(run_program("nohup", body));
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(kOk), "");
}

TEST(RunProgram, IsNotEndedBySignalsThatMeanNothingToIt) {
  const auto body = [](StopSignal& signal) {
    for (const int meaningless :
         {SIGUSR1, SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGPIPE}) {
      std::raise(meaningless);
    }
    return signal.wait(0) ? kFailed : kOk;
  };
  EXPECT_EXIT(std::_Exit(run_program("unmoved", body)), testing::ExitedWithCode(kOk), "");
}

TEST(RunProgram, SaysWhatWasThrownAndFails) {
  const auto body = [](StopSignal&) -> int { throw std::runtime_error("no cell today"); };
  EXPECT_EXIT(std::_Exit(run_program("unlucky", body)), testing::ExitedWithCode(kFailed),
              "unlucky: no cell today");
}

}  // namespace
}  // namespace clearance
