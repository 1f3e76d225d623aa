// The lists of fields compared with the IDL. A report with a different number in every field is
// compared with its copy over the wire.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <regex>
#include <set>
#include <vector>

#include "monitor/recording/layout_change.hpp"
#include "monitor/recording/topic_schema.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/gradient_message.hpp"
#include "monitor/wire/slow_message_fields.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance::test {
namespace {

// Gives every field a different number. Flags have only two values: a second report with other
// numbers has the opposite ones.
struct Numbered {
  std::uint64_t& next;

  template <class Value>
  void operator()(const Field&, Value& value) const {
    ++next;
    if constexpr (HasFields<Value>) {
      for_each_field(*this, value);
    } else if constexpr (std::is_same_v<Value, bool>) {
      value = next / 64 % 2 != 0;
    } else if constexpr (std::is_enum_v<Value>) {
      value = static_cast<Value>(next % 251);
    } else if constexpr (std::is_arithmetic_v<Value>) {
      value = static_cast<Value>(next);
    } else if constexpr (std::is_same_v<Value, Vec3>) {
      for (int i = 0; i < 3; ++i) value[i] = static_cast<double>(next++);
    } else {
      for (auto& element : value) (*this)(Field{}, element);
    }
  }
};

Report numbered_report(const Scene& scene, std::uint64_t first) {
  const GradientRows rows = gradient_rows(scene);
  Report report;
  report.pairs.resize(scene.pairs.size());
  report.zones.resize(scene.zones.size());
  report.separated_zones.resize(1);
  report.separated_pairs.resize(2);
  report.stops.resize(2);
  report.contacts.resize(contact_pairs(scene).size());
  report.hidden.resize(2);
  report.gradients.rates.resize(rows.variables.size());
  report.gradients.drifts.resize(rows.rows.size());
  report.gradients.alternatives.resize(rows.rows.size());
  for_each_field(Numbered{first}, report);
  return report;
}

// Compares a field of the report with that of the message.
struct ExpectSame {
  std::string of = {};

  template <class Ours, class Theirs>
  void operator()(const Field& field, const Ours& ours, const Theirs& theirs) const {
    const std::string name = fmt::format("{}{}", of, field.name);
    if constexpr (HasFields<Ours>) {
      for_each_field(ExpectSame{name + "."}, ours, theirs);
    } else if constexpr (std::is_same_v<Ours, Vec3>) {
      EXPECT_EQ(ours, Vec3(theirs.x, theirs.y, theirs.z)) << name;
    } else if constexpr (std::is_enum_v<Ours>) {
      EXPECT_EQ(static_cast<std::uint8_t>(ours), theirs) << name;
    } else if constexpr (std::is_arithmetic_v<Ours>) {
      EXPECT_EQ(ours, theirs) << name;
    } else {
      ASSERT_EQ(ours.size(), theirs._length) << name;
      for (std::uint32_t i = 0; i < theirs._length; ++i)
        (*this)(Field{fmt::format("{}[{}]", field.name, i)}, ours[i], theirs._buffer[i]);
    }
  }
};

template <class Message>
Sample<Message> through_the_wire(const Message& message) {
  CdrEncoder encoder;
  Sample<Message> came;
  EXPECT_TRUE(CdrDecoder().decode(encoder.encode(message), came));
  return came;
}

// A cell of links and a zone with `separation`, in which everything is published.
Scene published_cell() {
  Scene scene = scara_cell();
  scene.gradients = true;
  Zone& zone = scene.zones.emplace_back();
  zone.name = "people";
  zone.pairs = {0, 1};
  zone.separation.emplace();
  zone.separation->human_is_first = {1, 1};
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  scene.contacts.emplace_back().pairs = {3, 2};
  return scene;
}

// Messages with room for two stops of robots and two hidden pairs besides: the cell has none.
Sample<clearance_msg_Distances> roomy_distances(const Scene& scene) {
  Sample<clearance_msg_Distances> message = make_distances(scene);
  reserve_sequence(message->hidden, 2);
  return message;
}
Sample<clearance_msg_Separation> roomy_separation(const Scene& scene) {
  Sample<clearance_msg_Separation> message = make_separation(scene);
  reserve_sequence(message->stops, 2);
  return message;
}

class ReportFields : public testing::TestWithParam<std::uint64_t> {
 protected:
  Scene scene = published_cell();
  Report report = numbered_report(scene, GetParam());
};

TEST_P(ReportFields, OfDistancesComeThroughTheWire) {
  Sample<clearance_msg_Distances> message = roomy_distances(scene);
  const SourceUse use{SourceName("arm"), 99};
  ASSERT_TRUE(to_wire(report, {&use, 1}, 77, *message));
  const auto came = through_the_wire(*message);
  DistanceFields::for_each(ExpectSame{}, report, *came);
  EXPECT_EQ(77, came->publish_ns);
  ASSERT_EQ(1u, came->sources._length);
  EXPECT_STREQ("arm", came->sources._buffer[0].source);
  EXPECT_EQ(99u, came->sources._buffer[0].sequence_number);
}

TEST_P(ReportFields, OfZonesComeThroughTheWire) {
  const auto zone = static_cast<std::uint32_t>(scene.zones.size() - 1);
  clearance_msg_ZoneState message{};
  to_wire(scene, report, zone, message);
  const auto came = through_the_wire(message);
  PublishedZoneFields::for_each(ExpectSame{}, report.zones[zone], *came);
  EXPECT_EQ(zone, came->zone);
  EXPECT_STREQ("people", came->name);
  EXPECT_EQ(report.cycle, came->cycle);
  EXPECT_EQ(report.now_ns, came->now_ns);
}

TEST_P(ReportFields, OfSeparationComeThroughTheWire) {
  Sample<clearance_msg_Separation> message = roomy_separation(scene);
  to_wire(report, 77, *message);
  const auto came = through_the_wire(*message);
  TickFields::for_each(ExpectSame{}, report, *came);
  ExpectSame{}(Field{"pairs"}, report.separated_pairs, came->pairs);
  ExpectSame{}(Field{"zones"}, report.separated_zones, came->zones);
  ExpectSame{}(Field{"stops"}, report.stops, came->stops);
  EXPECT_EQ(77, came->publish_ns);
}

TEST_P(ReportFields, OfGradientsComeThroughTheWire) {
  const GradientRows rows = gradient_rows(scene);
  GradientMessage message(scene);
  const auto came = through_the_wire(message.of(report, 77));
  TickFields::for_each(ExpectSame{}, report, *came);
  EXPECT_EQ(77, came->publish_ns);
  ExpectSame{}(Field{"alternatives"}, report.gradients.alternatives, came->alternatives);
  ASSERT_EQ(rows.rows.size(), came->pairs._length);
  ASSERT_GT(rows.rows.size(), 2u);
  for (std::uint32_t r = 0; r < came->pairs._length; ++r) {
    const clearance_msg_PairGradient& pair = came->pairs._buffer[r];
    GradientPairFields::for_each(ExpectSame{}, report.pairs[rows.rows[r].published], pair);
    EXPECT_EQ(report.gradients.drifts[r], pair.drift);
    for (std::uint32_t i = 0; i < pair.joints._length; ++i) {
      EXPECT_EQ(rows.variables[rows.rows[r].first + i], pair.joints._buffer[i].joint);
      EXPECT_EQ(report.gradients.rates[rows.rows[r].first + i], pair.joints._buffer[i].rate);
    }
  }
}

// The reports of a share have the ids of its scene. Zones, cycles and what else is a number stay.
TEST_P(ReportFields, ThatMeanPairsAndNoOthersGetTheIdsOfAnotherList) {
  constexpr std::array<std::uint32_t, 3> kIds{12, 10, 11};
  const auto number = [&](clearance_msg_Distances& message, const auto& id_of) {
    message.minimum.pair = id_of(2u);
    for (std::uint32_t i = 0; i < message.pairs._length; ++i)
      message.pairs._buffer[i].pair = id_of(i);
    for (std::uint32_t i = 0; i < message.contacts._length; ++i)
      message.contacts._buffer[i].pair = id_of(i);
  };
  Sample<clearance_msg_Distances> message = make_distances(scene);
  ASSERT_TRUE(to_wire(report, {}, 77, *message));
  ASSERT_GT(message->pairs._length, kIds.size()) << "some ids have no counterpart";
  ASSERT_GT(message->contacts._length, 0u);
  CdrEncoder encoder;
  const auto bytes = [&](const auto& of) {
    const auto encoded = encoder.encode(of);
    return std::vector<std::byte>(encoded.begin(), encoded.end());
  };
  number(*message, [&](std::uint32_t i) { return i < kIds.size() ? kIds[i] : i; });
  const auto expected = bytes(*message);
  number(*message, [](std::uint32_t i) { return i; });
  const auto before = bytes(*message);
  MapPairs({}).in(*message);
  EXPECT_EQ(bytes(*message), before) << "a list without ids changes nothing";
  MapPairs(kIds).in(*message);
  EXPECT_EQ(bytes(*message), expected);
  clearance_msg_ZoneState zone{};
  zone.zone = zone.pair = 1;
  MapPairs(kIds).in(zone);
  EXPECT_EQ(zone.pair, 10u);
  EXPECT_EQ(zone.zone, 1u);
}

INSTANTIATE_TEST_SUITE_P(WithEachFlagSetAndNot, ReportFields, testing::Values(1, 65));

const IdlTypes& our_idl() {
  static const IdlTypes types = parse_idl(kIdlText);
  return types;
}

template <class Record>
class ListOf : public testing::Test {};
using Records =
    testing::Types<clearance_msg_SourceUse, clearance_msg_PairDistance, clearance_msg_Distances,
                   clearance_msg_ContactState, clearance_msg_HiddenState, clearance_msg_ZoneState,
                   clearance_msg_PairSeparation, clearance_msg_ZoneSeparation,
                   clearance_msg_RobotStop, clearance_msg_Separation, clearance_msg_JointGradient,
                   clearance_msg_PairGradient, clearance_msg_GradientAlternative,
                   clearance_msg_Gradients>;
TYPED_TEST_SUITE(ListOf, Records);

TYPED_TEST(ListOf, NamesEveryFieldThatTheIdlHasOnce) {
  ASSERT_EQ("", our_idl().error);
  std::vector<std::string> listed, defined;
  FieldsOf<TypeParam>::for_each([&](const Field& field) { listed.emplace_back(field.name); });
  const std::string type(FieldsOf<TypeParam>::kType);
  ASSERT_TRUE(our_idl().structs.contains(type));
  for (const IdlField& field : our_idl().structs.at(type)->fields) defined.push_back(field.name);
  EXPECT_THAT(listed, testing::UnorderedElementsAreArray(defined));
}

template <class Record>
class OrderOfList : public testing::Test {};
using SlowRecords = testing::Types<
    clearance_msg_RejectCount, clearance_msg_SourceHealth, clearance_msg_InputAge,
    clearance_msg_JointAge, clearance_msg_InputNote, clearance_msg_PartnerHealth,
    clearance_msg_ShareHealth, clearance_msg_WitnessHealth, clearance_msg_InputResponse,
    clearance_msg_Health, clearance_msg_CatalogueObject, clearance_msg_CataloguePair,
    clearance_msg_CatalogueZone, clearance_msg_CatalogueJoint, clearance_msg_CatalogueContact,
    clearance_msg_CatalogueShare, clearance_msg_Catalogue, clearance_msg_CommandResult,
    clearance_msg_MarginVerdict, clearance_msg_ProfilePart, clearance_msg_Answer>;
TYPED_TEST_SUITE(OrderOfList, SlowRecords);

// The place of a name decides which member it names.
TYPED_TEST(OrderOfList, IsThatOfTheIdl) {
  std::vector<std::string> listed, defined;
  FieldsOf<TypeParam>::for_each([&](const Field& field) { listed.emplace_back(field.name); });
  std::string text;
  for (const char* file : {"clearance", "commands", "questions"})
    text += read_text(places::sources() + "/idl/" + file + ".idl");
  text = std::regex_replace(text, std::regex("//[^\n]*"), "");
  const std::string begin = fmt::format("struct {} {{", FieldsOf<TypeParam>::kType);
  const std::size_t at = text.find(begin);
  ASSERT_NE(at, std::string::npos);
  const std::string body = text.substr(at, text.find('}', at) - at);
  const std::regex name("(\\w+)\\s*;");
  for (std::sregex_iterator each(body.begin(), body.end(), name), end; each != end; ++each)
    defined.push_back((*each)[1]);
  EXPECT_EQ(listed, defined);
}

template <class... Record>
std::set<std::string> types_of(testing::Types<Record...>) {
  return {std::string(FieldsOf<Record>::kType)...};
}

TEST(Lists, AreThoseOfEveryStructThatADaemonWrites) {
  std::set<std::string> expected;
  for (const auto& [name, of] : our_idl().structs) expected.insert(name);
  for (const char* input : {"Vector3", "Quaternion", "ObjectPose", "PoseBatch", "JointStates"})
    EXPECT_EQ(expected.erase(input), 1u) << input;
  std::set<std::string> listed = types_of(Records());
  listed.merge(types_of(SlowRecords()));
  EXPECT_TRUE(std::ranges::includes(listed, expected)) << testing::PrintToString(expected);
}

// The bytes of one field, found by its name in the IDL: the IDL is reduced to that field. `around`
// is the IDL of the structs that contain the field's struct. `begin` is the offset at which the
// value then begins.
std::vector<std::byte> bytes_by_name(std::span<const std::byte> cdr, const std::string& record,
                                     const IdlField& field, const std::string& around,
                                     std::string_view top, std::size_t begin) {
  const std::string only =
      fmt::format("module clearance {{ module msg {{ @final struct {} {{ {} {}; }}; {} }}; }};",
                  record, field.type.name, field.name, around);
  LayoutChange change(kIdlText, only, top);
  EXPECT_EQ("", change.error());
  const auto all = change.apply(cdr);
  EXPECT_GE(all.size(), 4 + begin + field.type.size);
  return {all.begin() + 4 + static_cast<std::ptrdiff_t>(begin),
          all.begin() + 4 + static_cast<std::ptrdiff_t>(begin + field.type.size)};
}

// Every number of `record` that the list names must be the one of that name in the IDL.
template <class Record>
void expect_names_of_the_idl(const Record& record, std::span<const std::byte> cdr,
                             const std::string& around, std::string_view top, bool in_sequence) {
  const std::string type(FieldsOf<Record>::kType);
  for_each_field(
      [&](const Field& field, const auto& value) {
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
          const auto& fields = our_idl().structs.at(type)->fields;
          const auto defined = std::ranges::find(fields, field.name, &IdlField::name);
          ASSERT_NE(fields.end(), defined);
          const std::size_t begin = in_sequence ? std::max<std::size_t>(4, sizeof value) : 0;
          const std::size_t from = in_sequence && sizeof value == 1 ? 4 : begin;
          const auto bytes = bytes_by_name(cdr, type, *defined, around, top, from);
          ASSERT_EQ(sizeof value, bytes.size());
          EXPECT_EQ(0, std::memcmp(bytes.data(), &value, sizeof value)) << type << field.name;
        }
      },
      record);
}

TEST_P(ReportFields, AreTheMembersOfTheirNames) {
  CdrEncoder encoder;
  Sample<clearance_msg_Distances> distances = roomy_distances(scene);
  ASSERT_TRUE(to_wire(report, {}, 77, *distances));
  const auto distances_cdr = encoder.encode(*distances);
  expect_names_of_the_idl(*distances, distances_cdr, "", "Distances", false);
  expect_names_of_the_idl(distances->minimum, distances_cdr,
                          "@final struct Distances { PairDistance minimum; };", "Distances", false);
  expect_names_of_the_idl(distances->contacts._buffer[0], distances_cdr,
                          "@final struct Distances { sequence<ContactState> contacts; };",
                          "Distances", true);
  expect_names_of_the_idl(distances->hidden._buffer[0], distances_cdr,
                          "@final struct Distances { sequence<HiddenState> hidden; };", "Distances",
                          true);
  clearance_msg_ZoneState zone{};
  to_wire(scene, report, 0, zone);
  expect_names_of_the_idl(zone, encoder.encode(zone), "", "ZoneState", false);
  Sample<clearance_msg_Separation> separation = roomy_separation(scene);
  to_wire(report, 77, *separation);
  const auto separation_cdr = encoder.encode(*separation);
  expect_names_of_the_idl(*separation, separation_cdr, "", "Separation", false);
  expect_names_of_the_idl(separation->pairs._buffer[0], separation_cdr,
                          "@final struct Separation { sequence<PairSeparation> pairs; };",
                          "Separation", true);
  expect_names_of_the_idl(separation->zones._buffer[0], separation_cdr,
                          "@final struct Separation { sequence<ZoneSeparation> zones; };",
                          "Separation", true);
  expect_names_of_the_idl(separation->stops._buffer[0], separation_cdr,
                          "@final struct Separation { sequence<RobotStop> stops; };", "Separation",
                          true);
  GradientMessage gradients(scene);
  const auto& message = gradients.of(report, 77);
  const auto gradients_cdr = encoder.encode(message);
  expect_names_of_the_idl(message, gradients_cdr, "", "Gradients", false);
  expect_names_of_the_idl(message.pairs._buffer[0], gradients_cdr,
                          "@final struct Gradients { sequence<PairGradient> pairs; };", "Gradients",
                          true);
  expect_names_of_the_idl(
      message.alternatives._buffer[0], gradients_cdr,
      "@final struct Gradients { sequence<GradientAlternative> alternatives; };", "Gradients",
      true);
}

}  // namespace
}  // namespace clearance::test
