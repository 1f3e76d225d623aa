// The daemon's topics as messages of clearance_msgs, through real DDS on loopback.
#include "monitor/publish/ros_messages.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance {
namespace {

using test::eventually;
using ZoneStates = clearance_msgs_msg_dds__ZoneStates_;

class RosMessagesTest : public testing::Test {
 protected:
  RosMessagesTest() { cell.ros.outputs.messages = "/left/clearance"; }
  dds_entity_t reader(TopicKind kind) {
    for (const auto& [of, type] : kRosMessageTypes) {
      if (of == kind)
        return client.ros_reader(type, "rt/left/clearance/" + std::string(topic(kind).key));
    }
    return 0;
  }
  // Waits for the next list of zones.
  const ZoneStates* next(dds_entity_t zones) {
    const bool came = eventually([&] { return test::take_next(zones, states); });
    return came ? &*states : nullptr;
  }
  static clearance_msg_ZoneState state(std::uint32_t zone, const char* name, bool active) {
    clearance_msg_ZoneState state{};
    state.zone = zone;
    state.active = active;
    std::strncpy(state.name, name, sizeof state.name - 1);
    return state;
  }

  Cell cell;
  DdsOptions dds = test::own_dds();
  Participant participant{dds}, client{dds};
  Sample<ZoneStates> states;
};

TEST_F(RosMessagesTest, HaveTheNamespaceOfTheCellAndTheHashesOfTheirTypes) {
  RosMessages messages(cell, participant);
  for (const auto& [kind, type] : kRosMessageTypes) {
    const dds_entity_t from = reader(kind);
    ASSERT_TRUE(eventually([&] { return test::matched_writers(from) == 1; })) << topic(kind).key;
    const std::vector<std::uint64_t> writers = writers_of(from);
    ASSERT_EQ(writers.size(), 1u);
    EXPECT_EQ(writer_facts(from, writers[0]).user_data, type.user_data);
  }
}

TEST_F(RosMessagesTest, ListAllZonesWhenOneHasChanged) {
  RosMessages messages(cell, participant);
  const auto first = state(0, "slow", true), second = state(1, "stop", false);
  messages.published(TopicKind::kZones, &first);
  messages.published(TopicKind::kZones, &second);
  messages.report_ended();
  const dds_entity_t zones = reader(TopicKind::kZones);  // late: the list is latched
  const ZoneStates* list = next(zones);
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->zones._length, 2u);
  EXPECT_STREQ(list->zones._buffer[1].name, "stop");
  EXPECT_FALSE(list->zones._buffer[1].active);
  messages.report_ended();  // nothing has changed: no message
  const auto active = state(1, "stop", true);
  messages.published(TopicKind::kZones, &active);
  messages.report_ended();
  list = next(zones);
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->zones._length, 2u);
  EXPECT_TRUE(list->zones._buffer[0].active);
  EXPECT_TRUE(list->zones._buffer[1].active);
}

TEST_F(RosMessagesTest, ForgetTheZonesOfTheCellBefore) {
  RosMessages messages(cell, participant);
  const auto first = state(0, "slow", true), second = state(1, "stop", false);
  messages.published(TopicKind::kZones, &first);
  messages.published(TopicKind::kZones, &second);
  clearance_msg_Catalogue catalogue{};
  char empty[] = "";
  catalogue.scene = catalogue.cell_yaml = empty;
  messages.published(TopicKind::kCatalogue, &catalogue);
  messages.published(TopicKind::kZones, &first);
  messages.report_ended();
  const ZoneStates* list = next(reader(TopicKind::kZones));
  ASSERT_NE(list, nullptr);
  EXPECT_EQ(list->zones._length, 1u);
}

TEST_F(RosMessagesTest, ListNoZoneThatWasNotWrittenAfterTheCatalogue) {
  RosMessages messages(cell, participant);
  const auto third = state(2, "third", true);
  messages.published(TopicKind::kZones, &third);
  messages.report_ended();
  const ZoneStates* list = next(reader(TopicKind::kZones));
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->zones._length, 1u);
  EXPECT_EQ(list->zones._buffer[0].zone, 2u);
  EXPECT_TRUE(list->zones._buffer[0].active);
}

}  // namespace
}  // namespace clearance
