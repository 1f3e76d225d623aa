// The daemon's output for people: the daemon never waits for its readers, and strangers cannot
// write into it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "tests/shared/full_pipe.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using testing::HasSubstr;

// Many sources and refused poses, which make the log write the most.
class Flood {
 public:
  Flood(Participant& participant, const Cell& cell)
      : writer_(participant.writer(TopicKind::kPoses, cell.topics.poses)), sample_(make_batch(1)) {}

  [[nodiscard]] dds_entity_t writer() const noexcept { return writer_; }

  // Sends one batch with a pose of an object that does not exist.
  void send(const std::string& source) {
    PoseBatch batch;
    batch.source = SourceName(source);
    batch.sequence_number = ++sent_;
    batch.samples.emplace_back().object = 77;
    to_wire(batch, *sample_);
    ASSERT_EQ(DDS_RETCODE_OK, dds_write(writer_, &*sample_));
  }
  void send_from_many() { send("source " + std::to_string(sent_ % 40)); }

 private:
  dds_entity_t writer_;
  Sample<clearance_msg_PoseBatch> sample_;
  std::uint64_t sent_ = 0;
};

// A daemon with its own cell, and everything that a client needs to communicate with it.
class DaemonOutput : public testing::Test {
 protected:
  void expect_reports_without_a_gap(int count, Flood& flood) {
    std::uint64_t cycle = 0;
    for (int i = 0; i < count; ++i) {
      const auto report = distances.next();
      ASSERT_NE(report, nullptr) << "nothing is published";
      if (i > 0) {
        ASSERT_EQ(cycle + 1, (*report)->cycle) << "publishing was held up";
      }
      cycle = (*report)->cycle;
      for (int batch = 0; batch < 4; ++batch) flood.send_from_many();
    }
  }

  CellFile cell{small_cell("small")};
  Cell read = cell.cell();
  DdsOptions dds = own_dds();
  Participant client{dds};
  Distances distances{client, read};
};

TEST_F(DaemonOutput, KeepsNothingWaitingThoughNobodyReadsIt) {
  FullPipe pipe;
  Flood flood(client, read);
  ChildProcess daemon(kDaemon, with({cell.path(), "--log-level", "trace"}, dds_arguments(dds)),
                      {.out = pipe.in(), .err = pipe.in()});
  ASSERT_TRUE(eventually([&] { return matched_readers(flood.writer()) == 1; })) << "it hangs";
  distances.settle();
  expect_reports_without_a_gap(400, flood);
  daemon.signal(SIGTERM);
  EXPECT_EQ(0, daemon.wait(std::chrono::seconds(20)));
}

TEST_F(DaemonOutput, LosesTheLogOfNoMomentInWhichItIsRead) {
  FullPipe pipe;
  Flood flood(client, read);
  ChildProcess daemon(kDaemon, with({cell.path()}, dds_arguments(dds)), {.err = pipe.in()});
  ASSERT_TRUE(eventually([&] { return matched_readers(flood.writer()) == 1; }));
  std::string log;
  EXPECT_TRUE(eventually([&] {
    log += pipe.read(10);
    return log.find("[started]") != std::string::npos;
  })) << log;
  EXPECT_TRUE(eventually([&] {
    flood.send("late");
    log += pipe.read(10);
    return log.find("poses from source 'late'") != std::string::npos;
  })) << log;
  daemon.signal(SIGTERM);
  EXPECT_EQ(0, daemon.wait()) << log;
}

TEST_F(DaemonOutput, EndsAfterItsTicksOrAnErrorThoughNobodyReadsIt) {
  FullPipe pipe;
  const ChildOptions unread{.out = pipe.in(), .err = pipe.in()};
  ChildProcess run(kDaemon, with({cell.path(), "--ticks", "5"}, dds_arguments(dds)), unread);
  EXPECT_EQ(0, run.wait(std::chrono::seconds(20)));
  ChildProcess missing(kDaemon, {"/nonexistent/cell.yaml"}, unread);
  EXPECT_EQ(3, missing.wait(std::chrono::seconds(20)));
}

TEST_F(DaemonOutput, IsNotWrittenByTheNamesOfStrangers) {
  Flood flood(client, read);
  ChildProcess daemon(kDaemon, with({cell.path()}, dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] { return matched_readers(flood.writer()) == 1; }));
  const std::string forged = "a\n2026 error: stop \x1b[2J\xff";
  EXPECT_TRUE(eventually([&] {
    flood.send(forged);
    return daemon.wrote("2026 error: stop");
  })) << daemon.output();
  EXPECT_THAT(daemon.output(), HasSubstr("'a\\x0A2026 error: stop \\x1B[2J\\xFF'"));
  EXPECT_THAT(daemon.output(), testing::Not(HasSubstr("\n2026 error: stop")));
  EXPECT_THAT(daemon.output(), testing::Not(HasSubstr("\x1b")));
  daemon.signal(SIGTERM);
  EXPECT_EQ(0, daemon.wait());
}

}  // namespace
}  // namespace clearance::test
