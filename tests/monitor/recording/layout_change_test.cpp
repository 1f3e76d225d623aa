// Messages of other builds in the layout of this one, compared with bytes that Cyclone encodes.
#include "monitor/recording/layout_change.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "monitor/files/build_info.hpp"
#include "monitor/files/writer.hpp"
#include "monitor/recording/recorded_cell.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/sensors/built_frames.hpp"
#include "monitor/wire/message_fields.hpp"
#include "other_version.h"
#include "tests/monitor/replay/offline_replay_run.hpp"
#include "tests/shared/places.hpp"

namespace clearance::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

template <class Sample>
std::vector<std::byte> encoded(const Sample& sample, const dds_topic_descriptor_t& type) {
  CdrEncoder encoder;
  const auto cdr = encoder.encode(&sample, type);
  return {cdr.begin(), cdr.end()};
}

// The IDL in a recording of the other build: other_version.idl with the structs of one version
// only, under the names of this build's structs.
std::string idl_of(const std::string& version) {
  std::string text = read_text(std::filesystem::path(test::places::sources()) /
                               "tests/monitor/wire/other_version.idl");
  text.erase(0, text.find("module"));
  const std::string_view other = version == "Older" ? "struct Newer" : "struct Older";
  for (std::size_t at; (at = text.find(other)) != std::string::npos;) {
    const std::size_t begin = text.rfind('@', at);
    text.erase(begin, text.find("\n};", at) + 3 - begin);
  }
  for (std::size_t at; (at = text.find(version)) != std::string::npos;)
    text.erase(at, version.size());
  return text;
}

TEST(LayoutChange, OfTheSameTypesIsNone) {
  LayoutChange change(kIdlText, topic_schema(TopicKind::kDistances).text, "Distances");
  EXPECT_EQ("", change.error());
  EXPECT_TRUE(change.is_none());
  EXPECT_THAT(change.not_recorded(), IsEmpty());
}

TEST(LayoutChange, FillsInWhatAnOlderBuildDidNotRecord) {
  LayoutChange change(idl_of("Older"), kIdlText, "ZoneState");
  ASSERT_EQ("", change.error());
  EXPECT_FALSE(change.is_none());
  EXPECT_THAT(change.not_recorded(),
              ElementsAre("ZoneState.cycle", "ZoneState.now_ns", "ZoneState.since_cycle",
                          "ZoneState.swept_clearance"));
  const other_msg_OlderZoneState older{2, 3, "stop", true, false, 4, 5, 6, 0.5};
  Sample<clearance_msg_ZoneState> read;
  const auto changed = change.apply(encoded(older, other_msg_OlderZoneState_desc));
  ASSERT_TRUE(CdrDecoder().decode(changed, read));
  const std::vector<std::byte> ours = encoded(*read, clearance_msg_ZoneState_desc);
  EXPECT_TRUE(std::ranges::equal(changed, ours)) << "padding, too, as its header states it";
  EXPECT_EQ(2u, read->zone);
  EXPECT_EQ(3u, read->daemon);
  EXPECT_STREQ("stop", read->name);
  EXPECT_TRUE(read->active);
  EXPECT_FALSE(read->certified);
  EXPECT_EQ(4u, read->cause);
  EXPECT_EQ(5u, read->cause_object);
  EXPECT_EQ(6u, read->pair);
  EXPECT_EQ(0.5, read->clearance);
  EXPECT_TRUE(std::isnan(read->swept_clearance));
  EXPECT_EQ(0u, read->since_cycle);
  EXPECT_EQ(0, read->now_ns);
}

TEST(LayoutChange, LeavesOutWhatANewerBuildAdded) {
  LayoutChange change(idl_of("Newer"), kIdlText, "ZoneState");
  ASSERT_EQ("", change.error());
  EXPECT_THAT(change.not_recorded(), IsEmpty());
  const other_msg_NewerZoneState newer{2, 3, "s", true, true, 4, 5, 6, 0.5, 0.25, 7, 8, 9, 1.5};
  Sample<clearance_msg_ZoneState> read;
  ASSERT_TRUE(
      CdrDecoder().decode(change.apply(encoded(newer, other_msg_NewerZoneState_desc)), read));
  EXPECT_EQ(0.25, read->swept_clearance);
  EXPECT_EQ(7u, read->since_cycle);
  EXPECT_EQ(8u, read->cycle);
  EXPECT_EQ(9, read->now_ns);
}

TEST(LayoutChange, GoesIntoListsAndFindsFieldsWhereverTheyStand) {
  LayoutChange change(idl_of("Older"), kIdlText, "Separation");
  ASSERT_EQ("", change.error());
  other_msg_OlderPairSeparation pairs[2] = {{1, 2, 2, 0.5, 10, 20}, {3, 4, 1, 0.25, 30, 40}};
  other_msg_OlderSeparation older{};
  older.cycle = 12;
  older.scene_revision = 41;
  older.pairs._buffer = pairs;
  older.pairs._length = older.pairs._maximum = 2;
  char gone[] = "gone";
  older.gone = gone;
  Sample<clearance_msg_Separation> read;
  ASSERT_TRUE(
      CdrDecoder().decode(change.apply(encoded(older, other_msg_OlderSeparation_desc)), read));
  EXPECT_EQ(12u, read->cycle);
  EXPECT_EQ(0, read->publish_ns);
  EXPECT_EQ(41u, read->scene_revision);
  EXPECT_EQ(0u, read->zones._length);
  ASSERT_EQ(2u, read->pairs._length);
  EXPECT_EQ(4u, read->pairs._buffer[1].pair);
  EXPECT_EQ(1u, read->pairs._buffer[1].validity);
  EXPECT_EQ(0.25, read->pairs._buffer[1].clearance);
  EXPECT_TRUE(std::isnan(read->pairs._buffer[1].scaling));
  EXPECT_EQ(30, read->pairs._buffer[1].age_human_ns);
  EXPECT_EQ(40, read->pairs._buffer[1].age_robot_ns);
}

// Frames of builds that did not record what carries a sensor end before it. Such builds had the
// frame's place known whatever the tick knew, as that of a sensor in the world.
TEST(LayoutChange, GivesFramesWithoutACarrierThatOfTheWorld) {
  std::string former = side_schema(SideTopic::kFrames).text;
  const std::size_t carrier = former.find("FrameCarrier carrier;");
  ASSERT_NE(carrier, std::string::npos);
  former.erase(carrier, std::string_view("FrameCarrier carrier;").size());
  BuiltFrame frame;
  frame.sensor = 3;
  frame.stamp_ns = 77;
  frame.carrier = {.kind = RobotBase::Kind::kLink, .object = 0, .robot = 1, .link = 2};
  frame.message.cdr.assign(7, std::byte{9});  // 7: an octet ends at a multiple of 4
  CdrEncoder encoder;
  const Sample<clearance_msg_SensorFrame> sample = to_wire(frame, 9, true);
  const auto now = encoder.encode(*sample);
  constexpr std::size_t kCarrier = 1 + 3 * 4;  // an octet and three numbers, without a gap
  const std::vector<std::byte> then(now.begin(), now.end() - kCarrier);
  CdrDecoder decoder;
  Sample<clearance_msg_SensorFrame> read;
  EXPECT_FALSE(decoder.decode(then, read)) << "it is not of this layout";
  LayoutChange change(former, side_schema(SideTopic::kFrames).text, "SensorFrame");
  ASSERT_EQ("", change.error());
  EXPECT_THAT(change.not_recorded(), ElementsAre("SensorFrame.carrier"));
  ASSERT_TRUE(decoder.decode(change.apply(then), read));
  const BuiltFrame found = from_wire(*read);
  EXPECT_EQ(found.sensor, 3u);
  EXPECT_EQ(found.stamp_ns, 77);
  EXPECT_EQ(found.message.cdr, frame.message.cdr);
  EXPECT_EQ(found.carrier.kind, RobotBase::Kind::kWorld);
}

TEST(LayoutChange, RefusesBytesCutOffAnywhereAndLengthsBeyondTheEnd) {
  LayoutChange change(idl_of("Older"), kIdlText, "ZoneState");
  const other_msg_OlderZoneState older{2, 3, "stop", true, false, 4, 5, 6, 0.5};
  std::vector<std::byte> bytes = encoded(older, other_msg_OlderZoneState_desc);
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_TRUE(change.apply(std::span(bytes).first(length)).empty()) << length;
  EXPECT_FALSE(change.apply(bytes).empty());
  std::vector<std::byte> longer = bytes;
  longer.resize(bytes.size() + 4);
  EXPECT_TRUE(change.apply(longer).empty()) << "by more than padding";
  bytes[4 + 16 + 3] = std::byte{0x7f};  // the name's length
  EXPECT_TRUE(change.apply(bytes).empty());
}

TEST(LayoutChange, RefusesAnArrayOfAnotherLength) {
  const std::string ours = "@final struct A { double x[3]; octet y; };";
  EXPECT_TRUE(LayoutChange(ours, ours, "A").is_none());
  EXPECT_EQ("A.x is double[4] there and double[3] here",
            LayoutChange("@final struct A { double x[4]; octet y; };", ours, "A").error());
  for (const char* const length : {"0", "2000", "-1", "n", ""}) {
    const std::string bad = "@final struct A { double x[" + std::string(length) + "]; };";
    EXPECT_NE("", LayoutChange(bad, ours, "A").error()) << length;
  }
}

TEST(LayoutChange, RefusesAFieldOfAnotherType) {
  const LayoutChange change("@final struct ZoneState { float clearance; };", kIdlText, "ZoneState");
  EXPECT_EQ("ZoneState.clearance is float there and double here", change.error());
}

TEST(LayoutChange, RefusesAnIdlThatItDoesNotUnderstand) {
  for (const char* const idl :
       {"@appendable struct ZoneState { double clearance; };", "struct ZoneState { double a[3]; };",
        "@final struct ZoneState { Unknown x; };",
        "module a { @final struct ZoneState { double x; };", "@final struct ZoneState { double",
        "union ZoneState", ""}) {
    EXPECT_NE("", LayoutChange(idl, kIdlText, "ZoneState").error()) << idl;
  }
}

// Recordings of other builds.

class OtherBuild : public OfflineReplayTest {
 protected:
  // Writes the run again with zones of another version. `schema` is the text of their types.
  template <class Other>
  void rewrite_zones(const std::string& schema, const dds_topic_descriptor_t& type,
                     const std::function<Other(const clearance_msg_ZoneState&)>& converted) {
    const std::vector<Kept> messages = messages_of(run);
    RecordingWriter writer(run, cell.topics, {.left_out = {TopicKind::kZones}});
    writer.describe(*catalogue_of_build(messages.front(), "another build"));
    const auto zones = writer.add_channel({"clearance::msg::ZoneState", "omgidl", schema}, "zones");
    for (const Kept& message : messages) {
      if (message.kind == TopicKind::kZones) {
        const auto zone = converted(*decoded<clearance_msg_ZoneState>(message));
        writer.write(zones, message.log_ns, encoded(zone, type));
      } else {
        writer.write(message.kind, message.log_ns, message.publish_ns,
                     std::span<const std::byte>(message.cdr));
      }
    }
    ASSERT_TRUE(writer.close());
  }
};

TEST_F(OtherBuild, RecordingOfANewerOneIsComparedInWhatThisOneKnows) {
  record_run(cell, run, {.nearest = 0.05});
  rewrite_zones<other_msg_NewerZoneState>(
      idl_of("Newer"), other_msg_NewerZoneState_desc, [](const clearance_msg_ZoneState& zone) {
        other_msg_NewerZoneState newer{};
        std::memcpy(newer.name, zone.name, sizeof zone.name);
        newer.zone = zone.zone;
        PublishedZoneFields::for_each([](const Field&, const auto& from, auto& to) { to = from; },
                                      zone, newer);
        newer.cycle = zone.cycle;
        newer.now_ns = zone.now_ns;
        newer.speed = 1.5;
        return newer;
      });
  EXPECT_EQ("", replay({.compare = Comparison::kBits}).text());
}

TEST_F(OtherBuild, RecordingOfAnOlderOneIsReplayedAndSaysWhatItLacks) {
  record_run(cell, run, {.nearest = 0.05});
  rewrite_zones<other_msg_OlderZoneState>(idl_of("Older"), other_msg_OlderZoneState_desc,
                                          [](const clearance_msg_ZoneState& zone) {
                                            other_msg_OlderZoneState older{};
                                            std::memcpy(older.name, zone.name, sizeof zone.name);
                                            older.zone = zone.zone;
                                            older.active = zone.active;
                                            older.certified = zone.certified;
                                            older.cause = zone.cause;
                                            older.cause_object = zone.cause_object;
                                            older.pair = zone.pair;
                                            older.clearance = zone.clearance;
                                            return older;
                                          });
  RecordingReader reader(run);
  RecordedMessage message;
  while (reader.next(message)) EXPECT_FALSE(message.cdr.empty());
  EXPECT_EQ("", reader.error());
  EXPECT_THAT(reader.not_recorded(), testing::Contains("ZoneState.swept_clearance"));
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_TRUE(result.ok()) << result.text();
  EXPECT_THAT(result.text(),
              HasSubstr("the recording does not have these fields, which were not compared: "
                        "ZoneState.cycle, ZoneState.now_ns"));
}

TEST_F(OtherBuild, RecordingOfATypeThatCannotBeReadIsRefusedWithItsBuild) {
  record_run(cell, run);
  rewrite_zones<other_msg_OlderZoneState>(
      "@final struct ZoneState { float clearance; };", other_msg_OlderZoneState_desc,
      [](const clearance_msg_ZoneState&) { return other_msg_OlderZoneState{}; });
  const OfflineReplay result = replay({.compare = Comparison::kBits});
  EXPECT_THAT(result.damage + result.error,
              AllOf(HasSubstr("run.mcap"), HasSubstr(kBuild),
                    HasSubstr("cannot read clearance::msg::ZoneState of the build that made it "
                              "(another build): ZoneState.clearance is float there and double "
                              "here")));
}

// A recording in the first layout. It must stay readable, whatever fields are added later.
TEST(FirstLayout, IsReadableForEver) {
  const std::filesystem::path file =
      std::filesystem::path(test::places::sources()) / "tests/monitor/recording/first_layout.mcap";
  RecordingOutline outlined = outline(file);
  ASSERT_EQ("", outlined.error);
  EXPECT_TRUE(outlined.has_gradients);
  const auto cell = recorded_cell(file, outlined);
  ASSERT_TRUE(cell && std::holds_alternative<Cell>(*cell));
  std::map<TopicKind, int> counts;
  for (const Kept& message : messages_of(file)) {
    ++counts[message.kind];
    if (message.kind != TopicKind::kDistances) continue;
    const auto report = decoded<clearance_msg_Distances>(message);
    EXPECT_EQ(2u, report->pairs_total);
    EXPECT_EQ(2u, report->pairs._length);
    EXPECT_EQ(report->cycle, static_cast<std::uint64_t>(counts[message.kind]));
  }
  EXPECT_EQ(45, counts[TopicKind::kDistances]);
  EXPECT_EQ(45, counts[TopicKind::kGradients]);
  EXPECT_EQ(45, counts[TopicKind::kSeparation]);
  EXPECT_GT(counts[TopicKind::kJointStates], 20);
  const OfflineReplay replay =
      replay_offline(std::get<Cell>(*cell), file, {.compare = Comparison::kBits});
  EXPECT_TRUE(replay.ok()) << replay.text();
  EXPECT_EQ(45u, replay.compared);
}

}  // namespace
}  // namespace clearance::test
