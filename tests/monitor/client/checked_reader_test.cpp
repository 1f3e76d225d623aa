// Messages that are not written in each tick: what a client does with those that are not as their
// daemon wrote them. Oracle: the CDR bytes, whose every bit is flipped before they are decoded.
#include "monitor/client/checked_reader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/participant/command_message.hpp"
#include "monitor/participant/question_message.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/config/cells.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/sealed.hpp"

namespace clearance {
namespace {

using test::eventually;
constexpr std::uint64_t kAddress = 9;

template <class Sequence>
auto& only(Sequence& sequence) {
  reserve_sequence(sequence, 1);
  return sequence._buffer[sequence._length++];
}

// With an element in every list that the messages here have.
void fill(Sample<clearance_msg_Health>& health) {
  health->cycle = 7;
  health->tick_p50_us = 12.5;
  health->recording = dds_string_dup("recording run.mcap");
  only(health->rejected) = {dds_string_dup("hand"), dds_string_dup("late"), 3, dds_string_dup("")};
  only(health->inputs) = {1, dds_string_dup("hand"), 5, true, false, false, "left", "right"};
  only(health->joints) = {2, dds_string_dup("elbow"), 6, false, true, "left", ""};
  only(health->sources) = {"left", 4, 3, 2, 1};
  only(health->notes) = {dds_string_dup("hand"), 1, "left", "right", true};
  std::strcpy(health->partner.partner, "one");
  health->partner.leads = true;
  only(health->shares) = {"arm", 1, 2, 3, 4, 5};
  only(health->witnesses) = {
      dds_string_dup("eye"), dds_string_dup("arm"), dds_string_dup("hand"), 30, 4, true, 0.5, 0.25};
  only(health->responses) = {dds_string_dup("left"), 1.5, 2.5};
}
void fill(Sample<clearance_msg_Catalogue>& catalogue) {
  catalogue = make_catalogue(read_good(cell_text(
      "objects:\n  - {name: a, sphere: {radius: 0.1}}\n  - {name: b, sphere: {radius: 0.1}}\n"
      "pairs: [{between: [a, b]}]\n"
      "zones: [{name: near, between: [a, b], enter_below: 1, leave_above: 1}]\n")));
  only(catalogue->contacts).name = dds_string_dup("grip");
  only(catalogue->joints).name = dds_string_dup("elbow");
  std::strcpy(only(catalogue->shares).name, "arm");
  only(catalogue->robots) = dds_string_dup("arm");
}
void fill(Sample<clearance_msg_ZoneState>& zone) {
  std::strcpy(zone->name, "near");
  zone->active = true;
  zone->clearance = -0.25;
}
void fill(Sample<clearance_msg_CommandResult>& result) {
  result = to_wire(CommandResult{.client = "planner", .request = 3, .reason = "no such object"}, 7);
}
void fill(Sample<clearance_msg_Answer>& answer) {
  answer = to_wire(QuestionResult{.client = "planner", .request = 3, .reason = "too long"}, 7);
  only(answer->margins).first = dds_string_dup("hand");
  only(answer->profile).second = dds_string_dup("table");
}

template <class Message>
class SlowMessage : public testing::Test {};
using Messages =
    testing::Types<clearance_msg_Health, clearance_msg_Catalogue, clearance_msg_ZoneState,
                   clearance_msg_CommandResult, clearance_msg_Answer>;
TYPED_TEST_SUITE(SlowMessage, Messages);

TYPED_TEST(SlowMessage, IsRefusedWhicheverOfItsBitsWasFlipped) {
  Sample<TypeParam> sent, came;
  fill(sent);
  seal(*sent, kAddress);
  ASSERT_EQ(delivery_error(*sent, kAddress), ReportError::kGood);
  EXPECT_EQ(delivery_error(*sent, kAddress + 1), ReportError::kOtherAddress);
  CdrEncoder encoder, again;
  CdrDecoder decoder;
  const auto encoded = encoder.encode(*sent);
  const std::vector<std::byte> good(encoded.begin(), encoded.end());
  ASSERT_TRUE(decoder.decode(good, came));
  EXPECT_EQ(delivery_error(*came, kAddress), ReportError::kGood) << "it comes as it was sent";
  std::size_t refused = 0;
  for (std::size_t bit = 32; bit < 8 * good.size(); ++bit) {  // behind the header
    std::vector<std::byte> bytes = good;
    bytes[bit / 8] ^= std::byte{1} << bit % 8;
    if (!decoder.decode(bytes, came)) continue;                             // DDS drops it
    const bool is_as_sent = std::ranges::equal(again.encode(*came), good);  // the bit is padding
    EXPECT_EQ(delivery_error(*came, kAddress) == ReportError::kGood, is_as_sent) << bit;
    refused += is_as_sent ? 0 : 1;
  }
  EXPECT_GT(refused, 4 * good.size());
}

TEST(CheckedReader, HandsOutNoStateOfAZoneThatIsNotAsItsDaemonWroteItAndCountsIt) {
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds);
  const dds_entity_t writer = daemon.writer(TopicKind::kZones, Topics{}.zones);
  client::Connection connection(dds);
  client::Zones zones(connection);
  ASSERT_TRUE(eventually([&] { return test::matched_readers(writer) > 0; }));
  clearance_msg_ZoneState state{};
  state.active = true;
  test::write_sealed(daemon, writer, state);
  ASSERT_TRUE(eventually([&] { return zones.update(), zones.states().contains(0); }));
  const auto write = [&](std::uint64_t count, ReportError why, const auto& change) {
    clearance_msg_ZoneState clear = state;
    clear.active = false;
    seal(clear, daemon.address(Topics{}.zones));
    change(clear);
    check_dds(dds_write(writer, &clear), "writing");
    EXPECT_TRUE(eventually([&] { return zones.update(), zones.refused().count == count; }));
    EXPECT_EQ(zones.refused().last, why);
    EXPECT_TRUE(zones.states().at(0).active);
  };
  EXPECT_EQ(client::text_of({zones.refused()}), "");
  write(1, ReportError::kCorrupt, [](auto& clear) { clear.clearance = 1.0; });
  EXPECT_EQ(client::text_of({zones.refused()}),
            "1 message of " + Topics{}.zones + " was refused, the last one as corrupt");
  write(2, ReportError::kCorrupt, [](auto& clear) { clear.delivery_checksum = 0; });
  write(3, ReportError::kOtherAddress, [](auto& clear) { seal(clear, 1); });
  state.active = false;
  test::write_sealed(daemon, writer, state);
  EXPECT_TRUE(eventually([&] { return zones.update(), !zones.states().at(0).active; }));
}

// The client keeps what it had before. It sends the request again, so a good result follows.
TEST(CheckedReader, HandsOutNoCatalogueHealthOrResultThatIsNotAsItsDaemonWroteIt) {
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds);
  const dds_entity_t catalogues = daemon.writer(TopicKind::kCatalogue, Topics{}.catalogue);
  const dds_entity_t healths = daemon.writer(TopicKind::kHealth, Topics{}.health);
  const dds_entity_t results = daemon.writer(TopicKind::kCommandResults, Topics{}.command_results);
  client::Connection connection(dds);
  client::Catalogue names(connection);
  client::Health health(connection);
  client::Commands commands(connection, "planner");
  Sample<clearance_msg_Catalogue> catalogue;
  Sample<clearance_msg_Health> doing;
  Sample<clearance_msg_CommandResult> result;
  fill(catalogue);
  fill(doing);
  fill(result);
  ASSERT_TRUE(eventually([&] {
    return test::matched_readers(catalogues) + test::matched_readers(healths) +
               test::matched_readers(results) ==
           3;
  }));
  for (const dds_return_t written : {dds_write(catalogues, &*catalogue),
                                     dds_write(healths, &*doing), dds_write(results, &*result)})
    ASSERT_EQ(written, DDS_RETCODE_OK);
  const auto have_refused = [&](std::uint64_t count) {
    names.update();
    health.update();
    (void)commands.result(result->request);
    return names.refused().count == count && health.refused().count == count &&
           commands.refused().count == count;
  };
  EXPECT_TRUE(eventually([&] { return have_refused(1); }));
  EXPECT_EQ(names.message(), nullptr);
  EXPECT_EQ(health.message(), nullptr);
  EXPECT_FALSE(commands.result(result->request));
  test::write_sealed(daemon, catalogues, *catalogue);
  test::write_sealed(daemon, healths, *doing);
  test::write_sealed(daemon, results, *result);
  EXPECT_TRUE(eventually([&] {
    return have_refused(1) && names.message() != nullptr && health.message() != nullptr &&
           commands.result(result->request);
  }));
}

}  // namespace
}  // namespace clearance
