// Commands and results as messages: every kind of change survives, and every value that is none is
// refused by its field.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "monitor/participant/command_message.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

Pose turned() {
  return {Vec3(1.5, -2.0, 0.25),
          Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()))};
}

// Two of each kind: with what may be left out, and without it.
std::vector<CellChange> every_change() {
  return {AddObject{"{name: ü, sphere: {radius: 1}}"},
          AddFromTemplate{"bin", "bin_7", {"things", "bins"}, turned()},
          AddFromTemplate{"bin", "bin_8", {}, {}},
          RemoveObject{"bin_7"},
          SetAbsent{"bin", true},
          SetAbsent{"bin", false},
          Attach{"part", "hand", turned(), {"finger", "palm"}, 0.002, true, 1.2},
          Attach{"part", "hand"},
          Detach{"part", turned()},
          Detach{"part"},
          AttachRobot{"gripper", "flange", turned(), 0.002, true},
          AttachRobot{"gripper", "flange"},
          DetachRobot{"gripper", turned(), {{"left", 0.01}, {"right", -0.02}}, true, true},
          DetachRobot{"gripper"},
          Place{"table", turned()},
          SetMaxSpeed{"cart", 1.5},
          SetMaxSpeed{"cart", std::nullopt},
          SetMargin{"cart", 0.01},
          SetMargin{"cart", std::nullopt},
          SetAgeLimit{"cart", 20'000'000},
          SetAgeLimit{"cart", std::nullopt},
          SetSource{"cart", "tracker"},
          SetSource{"cart", std::nullopt},
          SetPair{"a", "b", SetPair::Rule::kPublish},
          SetPair{"a", "b", SetPair::Rule::kLeaveOut, "they touch"},
          SetPair{"a", "b", SetPair::Rule::kUnstated},
          SetZoneThresholds{"stop", 0.1, 0.2},
          ReplaceCell{"name: x"},
          ReadCellAgain{""},
          ReadCellAgain{"cells/b.yaml"},
          ReplaceObject{"{name: ü, sphere: {radius: 2}}"},
          SetPair{"a", "b", SetPair::Rule::kNoException},
          AllowContact{"grip", "part", "finger", 0.001, {0.01, 5, 6, 7}, "planner", "held"},
          AllowContact{"grip", "part", "finger", 0.001, {}, "planner", "held"},
          WithdrawContact{"grip"},
          Note{"seen by the shift lead"}};
}

Command every_command() {
  return {.client = "planner",
          .request = 7,
          .scene_revision = 0xfedcba9876543210,
          .dry_run = true,
          .changes = every_change(),
          .files = {{"part.stl", std::string("solid\0x", 7)}, {"empty.obj", ""}}};
}

// The bytes on the wire, which contain every field.
std::string wire_bytes(const Command& command) {
  CdrEncoder encoder;
  const auto bytes = encoder.encode(*to_wire(command));
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Command decoded(const Command& command) {
  CdrEncoder encoder;
  CdrDecoder decoder;
  Sample<clearance_msg_Command> message;
  EXPECT_TRUE(decoder.decode(encoder.encode(*to_wire(command)), message));
  auto read = from_wire(*message);
  if (const auto* fault = std::get_if<MalformedField>(&read)) ADD_FAILURE() << fault->path;
  return std::get<Command>(std::move(read));
}

TEST(CommandMessage, HasEveryKindOfChange) {
  std::set<std::size_t> kinds;
  for (const CellChange& change : every_change()) kinds.insert(change.index());
  EXPECT_EQ(kinds.size(), std::variant_size_v<CellChange>);
}

TEST(CommandMessage, KeepsEveryFieldOfEveryChange) {
  const Command command = every_command(), read = decoded(command);
  EXPECT_EQ(read.client, "planner");
  EXPECT_EQ(read.request, 7u);
  EXPECT_EQ(read.scene_revision, 0xfedcba9876543210);
  EXPECT_TRUE(read.dry_run);
  ASSERT_EQ(read.files.size(), 2u);
  EXPECT_EQ(read.files[0].name, "part.stl");
  EXPECT_EQ(read.files[0].bytes, std::string("solid\0x", 7));
  EXPECT_EQ(read.files[1].bytes, "");
  ASSERT_EQ(read.changes.size(), command.changes.size());
  const auto& attach = std::get<Attach>(read.changes[6]);
  EXPECT_EQ(attach.object, "part");
  EXPECT_EQ(attach.to, "hand");
  ASSERT_TRUE(attach.carrier_from_object);
  EXPECT_EQ(attach.carrier_from_object->position, turned().position);
  EXPECT_EQ(attach.carrier_from_object->orientation.coeffs(), turned().orientation.coeffs());
  EXPECT_THAT(attach.touch, testing::ElementsAre("finger", "palm"));
  EXPECT_EQ(attach.overlap, 0.002);
  EXPECT_TRUE(attach.far);
  EXPECT_EQ(attach.mass, 1.2);
  EXPECT_FALSE(std::get<Attach>(read.changes[7]).carrier_from_object);
  EXPECT_FALSE(std::get<Attach>(read.changes[7]).overlap);
  EXPECT_EQ(std::get<SetPair>(read.changes[24]).rule, SetPair::Rule::kLeaveOut);
  const auto& detach = std::get<DetachRobot>(read.changes[12]);
  ASSERT_EQ(detach.joints.size(), 2u);
  EXPECT_EQ(detach.joints[1].joint, "right");
  EXPECT_EQ(detach.joints[1].position, -0.02);
  EXPECT_TRUE(detach.powered && detach.absent);
  EXPECT_FALSE(std::get<AttachRobot>(read.changes[11]).carrier_from_root);
  const std::size_t contact = read.changes.size() - 4;
  EXPECT_EQ(std::get<AllowContact>(read.changes[contact]).end, (ContactEnd{0.01, 5, 6, 7}));
  EXPECT_EQ(std::get<AllowContact>(read.changes[contact + 1]).end, ContactEnd{});
  EXPECT_EQ(std::get<Note>(read.changes.back()).text, "seen by the shift lead");
  EXPECT_EQ(wire_bytes(read), wire_bytes(command));
}

TEST(CommandMessage, DiffersInItsBytesForEachField) {
  const std::vector<std::pair<CellChange, CellChange>> pairs = {
      {SetMaxSpeed{"a", 1.0}, SetMaxSpeed{"a", 2.0}},
      {Note{"a"}, Note{"b"}},
      {SetAgeLimit{"a", 1}, SetAgeLimit{"a", 2}},
      {SetSource{"a", "s"}, SetSource{"a", "t"}},
      {SetZoneThresholds{"z", 1, 2}, SetZoneThresholds{"z", 1, 3}},
      {Detach{"a", turned()}, Detach{"a"}},
      {AddFromTemplate{"t", "a", {"g"}}, AddFromTemplate{"t", "a", {"h"}}},
      {Place{"a", turned()}, Place{"a"}},
      {AttachRobot{"a", "b", turned()}, AttachRobot{"a", "b"}},
      {DetachRobot{"a", {}, {{"j", 1.0}}}, DetachRobot{"a", {}, {{"j", 2.0}}}},
      {DetachRobot{"a", {}, {{"j", 1.0}}}, DetachRobot{"a", {}, {{"k", 1.0}}}},
      {DetachRobot{"a", {}, {}, true}, DetachRobot{"a", {}, {}, false, true}},
      {AllowContact{"c", "a", "b", 0.1, {}, "x", "y"},
       AllowContact{"c", "a", "b", 0.2, {}, "x", "y"}},
      {ReadCellAgain{"a"}, ReadCellAgain{"b"}}};
  for (const auto& [a, b] : pairs) {
    const Command first{.client = "c", .request = 1, .changes = {a}};
    const Command second{.client = "c", .request = 1, .changes = {b}};
    EXPECT_NE(wire_bytes(first), wire_bytes(second)) << a.index();
    EXPECT_EQ(wire_bytes(decoded(first)), wire_bytes(first)) << a.index();
  }
}

// Each slip makes one value of a valid message one that is none.
TEST(CommandMessage, IsRefusedByTheFieldThatHasNoValue) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto put = [](char*& text, const std::string& by) {
    dds_string_free(text);
    text = dds_string_dup(by.c_str());
  };
  using Message = clearance_msg_Command;
  const auto change = [](Message & m, int i) -> auto& { return m.changes._buffer[i]._u; };
  const std::vector<std::pair<std::string, std::function<void(Message&)>>> slips = {
      {"client", [](Message& m) { m.client[0] = '\0'; }},
      {"client", [](Message& m) { m.client[0] = '\xff'; }},
      {"request", [](Message& m) { m.request = 0; }},
      {"changes[3]",
       [](Message& m) {
         const std::uint32_t none = 200;
         std::memcpy(&m.changes._buffer[3]._d, &none, sizeof none);
       }},
      {"changes[0].add_object.yaml", [&](Message& m) { put(change(m, 0).add_object.yaml, ""); }},
      {"changes[0].add_object.yaml",
       [&](Message& m) { put(change(m, 0).add_object.yaml, "\xc3\x28"); }},
      {"changes[1].add_from_template.groups[1]",
       [&](Message& m) { put(change(m, 1).add_from_template.groups._buffer[1], ""); }},
      {"changes[1].add_from_template.world_from_object.position",
       [&](Message& m) { change(m, 1).add_from_template.world_from_object.position.y = kNaN; }},
      {"changes[4].set_absent.object",
       [&](Message& m) { put(change(m, 4).set_absent.object, std::string(65, 'n')); }},
      {"changes[6].attach.to", [&](Message& m) { put(change(m, 6).attach.to, ""); }},
      {"changes[6].attach.carrier_from_object.position",
       [&](Message& m) { change(m, 6).attach.carrier_from_object.value.position.x = INFINITY; }},
      {"changes[6].attach.carrier_from_object.orientation",
       [&](Message& m) { change(m, 6).attach.carrier_from_object.value.orientation.w += 1e-5; }},
      {"changes[6].attach.overlap", [&](Message& m) { change(m, 6).attach.overlap.value = kNaN; }},
      {"changes[8].detach.world_from_object.orientation",
       [&](Message& m) {
         change(m, 8).detach.world_from_object.value.orientation = {0, 0, 0, 0};
       }},
      {"changes[10].attach_robot.to", [&](Message& m) { put(change(m, 10).attach_robot.to, ""); }},
      {"changes[12].detach_robot.joints[1].joint",
       [&](Message& m) { put(change(m, 12).detach_robot.joints._buffer[1].joint, ""); }},
      {"changes[12].detach_robot.joints[0].position",
       [&](Message& m) { change(m, 12).detach_robot.joints._buffer[0].position = kNaN; }},
      {"changes[15].set_max_speed.m_per_s",
       [&](Message& m) { change(m, 15).set_max_speed.m_per_s.value = -INFINITY; }},
      {"changes[21].set_source.source",
       [&](Message& m) { put(change(m, 21).set_source.source.value, ""); }},
      {"changes[23].set_pair.rule", [&](Message& m) { change(m, 23).set_pair.rule = 5; }},
      {"changes[24].set_pair.reason",
       [&](Message& m) { put(change(m, 24).set_pair.reason, std::string(1001, 'r')); }},
      {"changes[26].set_zone_thresholds.leave_above",
       [&](Message& m) { change(m, 26).set_zone_thresholds.leave_above = kNaN; }},
      {"files[0].name", [&](Message& m) { put(m.files._buffer[0].name, "../x"); }},
      {"files[0].name", [&](Message& m) { put(m.files._buffer[0].name, ".hidden"); }},
      {"files[1].name", [&](Message& m) { put(m.files._buffer[1].name, "part.stl"); }},
  };
  for (const auto& [path, slip] : slips) {
    auto message = to_wire(every_command());
    slip(*message);
    const auto read = from_wire(*message);
    const auto* fault = std::get_if<MalformedField>(&read);
    ASSERT_NE(fault, nullptr) << path;
    EXPECT_EQ(fault->path, path);
    EXPECT_FALSE(fault->reason.empty());
    if (path.starts_with("changes[")) {
      EXPECT_EQ(fault->change, std::stoul(path.substr(8))) << path;
    }
    message->changes._buffer[3]._d = clearance_msg_CHANGE_REMOVE_OBJECT;  // for its release
  }
}

// Values that are not stated are not read.
TEST(CommandMessage, NamesNoMoreThanACellCanHold) {
  for (const std::size_t names : {4096u, 4097u}) {
    const Command command{
        .client = "planner",
        .request = 1,
        .changes = {Attach{"part", "hand", Pose{}, std::vector<std::string>(names, "table")}}};
    const auto message = to_wire(command);
    const auto read = from_wire(*message);
    const auto* fault = std::get_if<MalformedField>(&read);
    ASSERT_EQ(fault != nullptr, names > 4096u);
    if (fault != nullptr) {
      EXPECT_EQ(fault->path, "changes[0].attach.touch");
    }
  }
}

TEST(CommandMessage, MayHaveAnythingInFieldsThatAreNotStated) {
  auto message = to_wire({.client = "c", .request = 1, .changes = {Attach{"a", "b"}}});
  message->changes._buffer[0]._u.attach.carrier_from_object.value.position.x = NAN;
  message->changes._buffer[0]._u.attach.overlap.value = NAN;
  EXPECT_TRUE(std::holds_alternative<Command>(from_wire(*message)));
}

TEST(CommandMessage, CutOffAnywhereIsNoMessage) {
  CdrEncoder encoder;
  CdrDecoder decoder;
  const auto whole = encoder.encode(*to_wire(every_command()));
  Sample<clearance_msg_Command> message;
  ASSERT_TRUE(decoder.decode(whole, message));
  constexpr std::size_t kPadding = 4;
  for (std::size_t size = 0; size + kPadding < whole.size(); ++size)
    EXPECT_FALSE(decoder.decode(whole.first(size), message)) << size;
}

TEST(CommandMessage, OfAResultKeepsEveryField) {
  const CommandResult result{.client = "planner",
                             .request = 9,
                             .status = CommandStatus::kOverlap,
                             .change = 3,
                             .path = "objects[part].attached.to",
                             .reason = "found it too deep",
                             .scene_revision = 11,
                             .in_force_from = 12};
  const auto message = to_wire(result, 99);
  EXPECT_EQ(message->daemon, 99u);
  const CommandResult read = from_wire(*message);
  EXPECT_EQ(read.client, result.client);
  EXPECT_EQ(read.request, result.request);
  EXPECT_EQ(read.status, result.status);
  EXPECT_EQ(read.change, result.change);
  EXPECT_EQ(read.path, result.path);
  EXPECT_EQ(read.reason, result.reason);
  EXPECT_EQ(read.scene_revision, result.scene_revision);
  EXPECT_EQ(read.in_force_from, result.in_force_from);
}

TEST(CommandStatus, HasANameForEachValue) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kCommandStatuses; ++i)
    names.insert(name_of(static_cast<CommandStatus>(i)));
  EXPECT_EQ(names.size(), kCommandStatuses);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_EQ(name_of(static_cast<CommandStatus>(kCommandStatuses)), "unknown");
}

}  // namespace
}  // namespace clearance
