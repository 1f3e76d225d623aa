// The ledger decides which clients may command, in which order, and which results are repeated.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "monitor/dds/request_ledger.hpp"

namespace clearance {
namespace {

class CommandLedger : public RequestLedger<CommandResult> {
 public:
  explicit CommandLedger(const std::vector<std::string>& clients)
      : RequestLedger(clients, "commands") {}
};
using Next = CommandLedger::Next;

CommandResult done(std::uint64_t request, const std::string& client = "planner") {
  return {.client = client, .request = request, .scene_revision = 100 + request};
}

// Admits a request that must be new, and answers it.
void do_request(CommandLedger& ledger, std::uint64_t number, std::uint64_t content = 0) {
  ASSERT_EQ(ledger.admit({"planner", number, content}).next, Next::kDo) << number;
  ledger.answer(done(number));
}

TEST(CommandLedger, TakesNoCommandOfAClientThatIsNotNamed) {
  CommandLedger ledger({"planner"});
  EXPECT_EQ(ledger.refuse_sender({"planner", 1}, 7), std::nullopt);
  for (const char* name : {"operator", "", "Planner", "planner "}) {
    const auto refused = ledger.refuse_sender({name, 4}, 7);
    ASSERT_TRUE(refused) << name;
    EXPECT_EQ(refused->status, CommandStatus::kNotNamed);
    EXPECT_EQ(refused->client, name);
    EXPECT_EQ(refused->request, 4u);
    EXPECT_NE(refused->reason.find("found a request of '" + std::string(name) +
                                   "'; expected 'planner'. Send it"),
              std::string::npos)
        << refused->reason;
  }
}

TEST(CommandLedger, RefusesBothOfTwoWritersUnderOneNameUntilOneHasLeft) {
  CommandLedger ledger({"planner", "operator"});
  EXPECT_EQ(ledger.refuse_sender({"planner", 1}, 7), std::nullopt);
  EXPECT_EQ(ledger.refuse_sender({"operator", 1}, 8), std::nullopt);
  EXPECT_EQ(ledger.refuse_sender({"planner", 2}, 8)->status, CommandStatus::kTwoWriters);
  EXPECT_EQ(ledger.refuse_sender({"planner", 2}, 7)->status, CommandStatus::kTwoWriters);
  EXPECT_EQ(ledger.refuse_sender({"operator", 2}, 8), std::nullopt);
  const std::vector<std::uint64_t> left = {8};
  ledger.keep_writers(left);
  EXPECT_EQ(ledger.refuse_sender({"planner", 3}, 8), std::nullopt);
  EXPECT_EQ(ledger.refuse_sender({"planner", 3}, 9)->status, CommandStatus::kTwoWriters);
}

TEST(CommandLedger, KeepsRefusingHoweverManyWritersComeUnderAName) {
  CommandLedger ledger({"planner"});
  for (std::uint64_t writer = 1; writer < 100; ++writer)
    (void)ledger.refuse_sender({"planner", 1}, writer);
  const std::vector<std::uint64_t> left = {1, 2};
  ledger.keep_writers(left);
  EXPECT_EQ(ledger.refuse_sender({"planner", 1}, 1)->status, CommandStatus::kTwoWriters);
}

TEST(CommandLedger, DoesARequestOnceAndAnswersItAgain) {
  CommandLedger ledger({"planner"});
  const CommandLedger::Request request{"planner", 5, 0xabc};
  EXPECT_EQ(ledger.admit(request).next, Next::kDo);
  EXPECT_EQ(ledger.admit(request).next, Next::kWait);
  ledger.answer(done(5));
  for (int i = 0; i < 3; ++i) {
    const auto verdict = ledger.admit(request);
    EXPECT_EQ(verdict.next, Next::kAnswer);
    EXPECT_EQ(verdict.result.scene_revision, 105u);
  }
}

TEST(CommandLedger, AnswersARefusalAgainToo) {
  CommandLedger ledger({"planner"});
  ASSERT_EQ(ledger.admit({"planner", 1, 2}).next, Next::kDo);
  ledger.answer({.client = "planner", .request = 1, .status = CommandStatus::kOverlap});
  EXPECT_EQ(ledger.admit({"planner", 1, 2}).result.status, CommandStatus::kOverlap);
}

TEST(CommandLedger, RefusesAnotherCommandUnderAKnownNumber) {
  CommandLedger ledger({"planner"});
  ASSERT_EQ(ledger.admit({"planner", 5, 1}).next, Next::kDo);
  EXPECT_EQ(ledger.admit({"planner", 5, 2}).result.status, CommandStatus::kOtherContent);
  ledger.answer(done(5));
  EXPECT_EQ(ledger.admit({"planner", 5, 2}).result.status, CommandStatus::kOtherContent);
  EXPECT_EQ(ledger.admit({"planner", 5, 1}).result.status, CommandStatus::kDone);
}

TEST(CommandLedger, RefusesAnOlderRequestThatItDoesNotKnow) {
  CommandLedger ledger({"planner"});
  do_request(ledger, 10);
  EXPECT_EQ(ledger.admit({"planner", 9, 0}).result.status, CommandStatus::kOutOfOrder);
  do_request(ledger, 12);
  EXPECT_EQ(ledger.admit({"planner", 11, 0}).result.status, CommandStatus::kOutOfOrder);
  EXPECT_EQ(ledger.admit({"planner", 10, 0}).result.status, CommandStatus::kDone);
}

TEST(CommandLedger, CountsEachClientByItself) {
  CommandLedger ledger({"planner", "operator"});
  do_request(ledger, 10);
  EXPECT_EQ(ledger.admit({"operator", 3, 0}).next, Next::kDo);
}

TEST(CommandLedger, KnowsTheLastResultsAndNoMore) {
  CommandLedger ledger({"planner"});
  for (std::uint64_t i = 1; i <= CommandLedger::kKnown + 5; ++i) do_request(ledger, i);
  EXPECT_EQ(ledger.admit({"planner", 6, 0}).result.status, CommandStatus::kDone);
  EXPECT_EQ(ledger.admit({"planner", 5, 0}).result.status, CommandStatus::kOutOfOrder);
}

TEST(CommandLedger, TakesLowerNumbersOfAProgramThatStartedAgainAndStillKnowsTheFormerResults) {
  CommandLedger ledger({"planner"});
  const std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
  ASSERT_EQ(ledger.refuse_sender({"planner", largest}, 7), std::nullopt);
  do_request(ledger, largest);
  EXPECT_EQ(ledger.admit({"planner", 40, 0}).result.status, CommandStatus::kOutOfOrder);
  ledger.keep_writers({});
  ASSERT_EQ(ledger.refuse_sender({"planner", 40}, 8), std::nullopt);
  do_request(ledger, 40);
  EXPECT_EQ(ledger.admit({"planner", 39, 0}).result.status, CommandStatus::kOutOfOrder);
  EXPECT_EQ(ledger.admit({"planner", largest, 0}).next, Next::kAnswer);
  EXPECT_EQ(ledger.admit({"planner", largest, 0}).result.status, CommandStatus::kDone);
}

TEST(CommandLedger, TakesNoLowerNumbersWhileTheSameProgramRuns) {
  CommandLedger ledger({"planner"});
  const std::vector<std::uint64_t> left = {7};
  ASSERT_EQ(ledger.refuse_sender({"planner", 10}, 7), std::nullopt);
  do_request(ledger, 10);
  ledger.keep_writers(left);
  ASSERT_EQ(ledger.refuse_sender({"planner", 9}, 7), std::nullopt);
  EXPECT_EQ(ledger.admit({"planner", 9, 0}).result.status, CommandStatus::kOutOfOrder);
}

TEST(CommandLedger, CountsAWithdrawnRequestAsNotSentForTheOrderToo) {
  CommandLedger ledger({"planner"});
  do_request(ledger, 10);
  ASSERT_EQ(ledger.admit({"planner", 20, 0}).next, Next::kDo);
  ledger.withdraw({"planner", 20, 0});
  EXPECT_EQ(ledger.admit({"planner", 9, 0}).result.status, CommandStatus::kOutOfOrder);
  EXPECT_EQ(ledger.admit({"planner", 15, 0}).next, Next::kDo);
}

TEST(CommandLedger, CountsAWithdrawnRequestAsNotSent) {
  CommandLedger ledger({"planner"});
  do_request(ledger, 1);
  ASSERT_EQ(ledger.admit({"planner", 2, 0}).next, Next::kDo);
  ledger.withdraw({"planner", 2, 0});
  EXPECT_EQ(ledger.admit({"planner", 2, 7}).next, Next::kDo);
}

}  // namespace
}  // namespace clearance
