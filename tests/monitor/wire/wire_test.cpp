#include <dds/dds.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "monitor/files/build_info.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/cyclone_private.hpp"
#include "tests/monitor/wire/wire_samples.hpp"

namespace clearance::test {
namespace {

std::vector<std::byte> copy(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

template <class T>
std::vector<std::byte> encoded(const Sample<T>& sample) {
  CdrEncoder encoder;
  return copy(encoder.encode(*sample));
}

// A participant that receives only its own messages.
class OwnDomain {
 public:
  OwnDomain() {
    constexpr dds_domainid_t kDomain = 171;
    domain_ = dds_create_domain(kDomain, "<General><Transport>none</Transport></General>");
    participant = dds_create_participant(kDomain, nullptr, nullptr);
  }
  ~OwnDomain() { dds_delete(domain_); }
  dds_entity_t participant = 0;

 private:
  dds_entity_t domain_ = 0;
};

// The bytes that dds_takecdr returns for a sample written through Cyclone.
template <class T>
std::vector<std::byte> through_dds(dds_entity_t participant, const Sample<T>& sample) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t topic =
      dds_create_topic(participant, &topic_descriptor<T>(), "wire_test", qos, nullptr);
  const dds_entity_t reader = dds_create_reader(participant, topic, qos, nullptr);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  EXPECT_EQ(DDS_RETCODE_OK, dds_write(writer, &*sample));
  ddsi_serdata* serdata = nullptr;
  dds_sample_info_t info;
  EXPECT_EQ(1, dds_takecdr(reader, &serdata, 1, &info, DDS_ANY_STATE));
  std::vector<std::byte> bytes(serdata == nullptr ? 0 : ddsi_serdata_size(serdata));
  if (serdata != nullptr) {
    ddsi_serdata_to_ser(serdata, 0, bytes.size(), bytes.data());
    ddsi_serdata_unref(serdata);
  }
  dds_delete(writer);
  dds_delete(reader);
  dds_delete(topic);
  return bytes;
}

template <class T>
class EveryTopic : public testing::Test {};
using Topics =
    testing::Types<clearance_msg_PoseBatch, clearance_msg_Distances, clearance_msg_Catalogue,
                   clearance_msg_ZoneState, clearance_msg_Health, clearance_msg_Separation>;
TYPED_TEST_SUITE(EveryTopic, Topics);

TYPED_TEST(EveryTopic, EncodesToTheBytesThatDdsCarries) {
  std::mt19937_64 random(1);
  OwnDomain domain;
  ASSERT_GT(domain.participant, 0);
  for (int i = 0; i < 20; ++i) {
    Sample<TypeParam> sample;
    fill(random, sample);
    EXPECT_EQ(through_dds(domain.participant, sample), encoded(sample));
  }
}

TYPED_TEST(EveryTopic, DecodesToWhatWasEncodedAlsoIntoAUsedSample) {
  std::mt19937_64 random(2);
  CdrDecoder decoder;
  Sample<TypeParam> reused;
  for (int i = 0; i < 50; ++i) {
    Sample<TypeParam> sample;
    fill(random, sample);
    const std::vector<std::byte> bytes = encoded(sample);
    ASSERT_TRUE(decoder.decode(bytes, reused));
    EXPECT_EQ(bytes, encoded(reused));
  }
}

TYPED_TEST(EveryTopic, RefusesBytesCutOffAnywhere) {
  std::mt19937_64 random(3);
  Sample<TypeParam> sample;
  fill(random, sample);
  const std::vector<std::byte> bytes = encoded(sample);
  const std::size_t padding = std::to_integer<std::size_t>(bytes[3]);
  CdrDecoder decoder;
  Sample<TypeParam> decoded;
  for (std::size_t length = 0; length < bytes.size() - padding; ++length) {
    EXPECT_FALSE(decoder.decode({bytes.data(), length}, decoded)) << length;
  }
}

TYPED_TEST(EveryTopic, SurvivesFlippedBitsAndWhatItAcceptsCanBeEncoded) {
  std::mt19937_64 random(4);
  CdrDecoder decoder;
  int accepted = 0;
  for (int i = 0; i < 3000; ++i) {
    Sample<TypeParam> sample;
    fill(random, sample);
    std::vector<std::byte> bytes = encoded(sample);
    for (int flip = 0; flip < 3; ++flip) {
      bytes[random() % bytes.size()] ^= static_cast<std::byte>(1u << random() % 8);
    }
    Sample<TypeParam> decoded;
    if (!decoder.decode(bytes, decoded)) continue;
    ++accepted;
    EXPECT_FALSE(encoded(decoded).empty());
  }
  EXPECT_GT(accepted, 100);
}

TYPED_TEST(EveryTopic, RefusesTrailingBytesOfAnotherLayout) {
  std::mt19937_64 random(5);
  Sample<TypeParam> sample;
  fill(random, sample);
  std::vector<std::byte> bytes = encoded(sample);
  bytes.resize(bytes.size() + 8);
  EXPECT_FALSE(CdrDecoder().decode(bytes, sample));
}

TEST(Cdr, ReadsBigEndianWriters) {
  // ZoneState {zone 2, daemon 3, "stop", active, not certified, cause 2, object 4, pair 5,
  // clearance 0.5 and 0.25, since 7, cycle 9, now 1, checksum 11, address 12}
  constexpr unsigned char kBytes[] = {0,    0,    0, 0,  // encapsulation: XCDR1, big-endian
                                      0,    0,    0, 2,  0,   0,   0,   0,  // zone, padding to 8
                                      0,    0,    0, 0,  0,   0,   0,   3,  // daemon
                                      0,    0,    0, 5,  's', 't', 'o', 'p', 0, 1, 0, 2,  //
                                      0,    0,    0, 4,                     // cause_object
                                      0,    0,    0, 5,  0,   0,   0,   0,  // pair, padding to 8
                                      0x3f, 0xe0, 0, 0,  0,   0,   0,   0,  // 0.5
                                      0x3f, 0xd0, 0, 0,  0,   0,   0,   0,  // 0.25
                                      0,    0,    0, 0,  0,   0,   0,   7,   0, 0, 0, 0, 0, 0,
                                      0,    9,    0, 0,  0,   0,   0,   0,   0, 1, 0, 0, 0, 0,
                                      0,    0,    0, 11, 0,   0,   0,   0,   0, 0, 0, 12};
  Sample<clearance_msg_ZoneState> zone;
  CdrDecoder decoder;
  ASSERT_TRUE(decoder.decode(std::as_bytes(std::span(kBytes)), zone));
  EXPECT_EQ(2u, zone->zone);
  EXPECT_EQ(3u, zone->daemon);
  EXPECT_STREQ("stop", zone->name);
  EXPECT_TRUE(zone->active);
  EXPECT_FALSE(zone->certified);
  EXPECT_EQ(2u, zone->cause);
  EXPECT_EQ(4u, zone->cause_object);
  EXPECT_EQ(5u, zone->pair);
  EXPECT_EQ(0.5, zone->clearance);
  EXPECT_EQ(0.25, zone->swept_clearance);
  EXPECT_EQ(7u, zone->since_cycle);
  EXPECT_EQ(9u, zone->cycle);
  EXPECT_EQ(1, zone->now_ns);
  EXPECT_EQ(11u, zone->delivery_checksum);
  EXPECT_EQ(12u, zone->address);
}

TEST(Cdr, RefusesASequenceBeyondItsBound) {
  Sample<clearance_msg_Distances> report;
  reserve_sequence(report->sources, clearance_msg_kMaxSources + 1);
  report->sources._length = clearance_msg_kMaxSources + 1;
  EXPECT_TRUE(encoded(report).empty());
}

Scene small_scene() {
  Scene scene;
  scene.name = "small";
  scene.revision = 77;
  scene.objects.resize(3);
  scene.objects[0].name = "floor";
  scene.objects[0].fixed = true;
  scene.objects[1].name = "hand";
  scene.objects[1].parts.resize(2);
  scene.objects[1].parts[0].name = "palm";
  scene.objects[1].parts[1].name = "thumb";
  scene.objects[2].name = "box";
  scene.pairs = {{0, 1, true}, {0, 2, false}, {1, 2, true}};
  scene.zones.push_back({"stop", "hands", "boxes", 0.05, 0.08, {2}});
  return scene;
}

TEST(Convert, ReportFillsAPreparedSampleWithoutMovingItsStorage) {
  const Scene scene = small_scene();
  Sample<clearance_msg_Distances> sample = make_distances(scene);
  const auto* const storage = sample->pairs._buffer;
  Report report;
  report.cycle = 12;
  report.now_ns = 1000;
  report.minimum.distance = 0.25;
  report.minimum.witness_b = Vec3(1.0, 2.0, 3.0);
  report.pairs.resize(2);
  report.pairs[1].pair = 2;
  report.pairs[1].status = PairStatus::kCarried;
  report.pairs[1].lower = -kInfinity;
  const SourceUse use{SourceName("arm"), 99};

  EXPECT_TRUE(to_wire(report, {&use, 1}, 1234, *sample));
  EXPECT_EQ(storage, sample->pairs._buffer);
  EXPECT_EQ(12u, sample->cycle);
  EXPECT_EQ(1234, sample->publish_ns);
  EXPECT_EQ(0.25, sample->minimum.distance);
  EXPECT_EQ(3.0, sample->minimum.witness_b.z);
  ASSERT_EQ(2u, sample->pairs._length);
  EXPECT_EQ(static_cast<std::uint8_t>(PairStatus::kCarried), sample->pairs._buffer[1].status);
  EXPECT_EQ(-kInfinity, sample->pairs._buffer[1].lower);
  ASSERT_EQ(1u, sample->sources._length);
  EXPECT_STREQ("arm", sample->sources._buffer[0].source);
  EXPECT_EQ(99u, sample->sources._buffer[0].sequence_number);
}

TEST(Convert, ReportThatDoesNotFitSaysSo) {
  const Scene scene = small_scene();
  Sample<clearance_msg_Distances> sample = make_distances(scene);
  Report report;
  report.pairs.resize(3);
  EXPECT_FALSE(to_wire(report, {}, 0, *sample));
  EXPECT_EQ(2u, sample->pairs._length);
  report.pairs.resize(2);
  EXPECT_TRUE(to_wire(report, {}, 0, *sample));
  const std::vector<SourceUse> uses(clearance_msg_kMaxSources + 1, {SourceName("arm"), 9, 8});
  EXPECT_TRUE(to_wire(report, std::span(uses).first(clearance_msg_kMaxSources), 0, *sample));
  EXPECT_FALSE(to_wire(report, uses, 0, *sample));
  EXPECT_EQ(clearance_msg_kMaxSources, sample->sources._length);
  EXPECT_EQ(clearance_msg_kMaxSources, sample->source_contents._length);
  EXPECT_EQ(8u, sample->source_contents._buffer[clearance_msg_kMaxSources - 1]);
}

TEST(Convert, ReportNamesTheZonesThatAreActiveAsFarAsItHasRoom) {
  const Scene scene = small_scene();
  Sample<clearance_msg_Distances> sample = make_distances(scene);
  Report report;
  report.zones.resize(3);
  for (const std::uint32_t zone : {2u, 0u}) {
    report.zones[zone].active = true;
    EXPECT_TRUE(to_wire(report, {}, 0, *sample));
    ASSERT_EQ(1u, sample->active_zones._length) << "the scene has one zone";
    EXPECT_EQ(zone, sample->active_zones._buffer[0]);
  }
}

// No two numbers and no two names of a kind are the same, so that no field can stand for another.
TEST(Convert, CatalogueHasEveryFieldOfTheScene) {
  Scene scene = small_scene();
  scene.rate_hz = 250.0;
  scene.zones.push_back({"slow", "people", "arms", 0.5, 0.6, {1}});
  for (const char* joint : {"shoulder", "elbow"}) scene.variables.emplace_back().name = joint;
  const Sample<clearance_msg_Catalogue> catalogue =
      make_catalogue({.scene = scene, .yaml = "name: small\n", .hash = "ab12"});
  EXPECT_STREQ("ab12", catalogue->cell_hash);
  EXPECT_STREQ(kBuild, catalogue->build);
  EXPECT_STREQ("small", catalogue->scene);
  EXPECT_EQ(77u, catalogue->scene_revision);
  EXPECT_EQ(250.0, catalogue->rate_hz);
  EXPECT_STREQ("name: small\n", catalogue->cell_yaml);
  ASSERT_EQ(scene.objects.size(), catalogue->objects._length);
  for (std::uint32_t i = 0; i < catalogue->objects._length; ++i) {
    const clearance_msg_CatalogueObject& object = catalogue->objects._buffer[i];
    EXPECT_EQ(i, object.id);
    EXPECT_EQ(scene.objects[i].name, object.name);
    EXPECT_EQ(scene.objects[i].fixed, object.is_fixed);
    ASSERT_EQ(scene.objects[i].parts.size(), object.parts._length);
    for (std::uint32_t p = 0; p < object.parts._length; ++p)
      EXPECT_EQ(scene.objects[i].parts[p].name, object.parts._buffer[p]);
  }
  ASSERT_EQ(scene.pairs.size(), catalogue->pairs._length);
  for (std::uint32_t i = 0; i < catalogue->pairs._length; ++i) {
    const clearance_msg_CataloguePair& pair = catalogue->pairs._buffer[i];
    EXPECT_EQ(i, pair.id);
    EXPECT_EQ(scene.pairs[i].first, pair.object_a);
    EXPECT_EQ(scene.pairs[i].second, pair.object_b);
    EXPECT_EQ(scene.pairs[i].publish, pair.published);
  }
  ASSERT_EQ(scene.zones.size(), catalogue->zones._length);
  for (std::uint32_t i = 0; i < catalogue->zones._length; ++i) {
    const clearance_msg_CatalogueZone& zone = catalogue->zones._buffer[i];
    EXPECT_EQ(i, zone.id);
    EXPECT_EQ(scene.zones[i].name, zone.name);
    EXPECT_EQ(scene.zones[i].group_a, zone.group_a);
    EXPECT_EQ(scene.zones[i].group_b, zone.group_b);
    EXPECT_EQ(scene.zones[i].enter_below, zone.enter_below);
    EXPECT_EQ(scene.zones[i].leave_above, zone.leave_above);
  }
  ASSERT_EQ(scene.variables.size(), catalogue->joints._length);
  for (std::uint32_t i = 0; i < catalogue->joints._length; ++i) {
    EXPECT_EQ(i, catalogue->joints._buffer[i].id);
    EXPECT_EQ(scene.variables[i].name, catalogue->joints._buffer[i].name);
  }
}

TEST(Convert, ZoneStateCarriesNameAndTickAndCutsAnOverlongName) {
  Scene scene = small_scene();
  scene.zones[0].name = std::string(100, 'z');
  Report report;
  report.cycle = 5;
  report.now_ns = 6;
  report.zones.resize(1);
  report.zones[0] = {true, true, true, 2, 0.04, 0.03, 3};
  Sample<clearance_msg_ZoneState> zone;
  to_wire(scene, report, 0, *zone);
  EXPECT_EQ(std::string(64, 'z'), zone->name);
  EXPECT_TRUE(zone->active);
  EXPECT_EQ(0.04, zone->clearance);
  EXPECT_EQ(0.03, zone->swept_clearance);
  EXPECT_EQ(3u, zone->since_cycle);
  EXPECT_EQ(5u, zone->cycle);
  EXPECT_EQ(6, zone->now_ns);
  scene.zones[0].name = "stop";  // the message still has the longer name
  to_wire(scene, report, 0, *zone);
  EXPECT_STREQ("stop", zone->name);
}

TEST(Convert, PosesComeBackBitForBit) {
  std::mt19937_64 random(6);
  PoseBatch sent{SourceName("arm"), 41, 42, std::vector<PoseSample>(50)};
  for (PoseSample& sample : sent.samples) {
    sample.object = static_cast<std::uint32_t>(random());
    sample.stamp_ns = static_cast<std::int64_t>(random());
    for (int i = 0; i < 3; ++i) sample.world_from_object.position[i] = any_double(random);
    for (int i = 0; i < 4; ++i)
      sample.world_from_object.orientation.coeffs()[i] = any_double(random);
    sample.has_twist = random() % 2 != 0;
    for (int i = 0; i < 3; ++i) sample.twist.linear[i] = any_double(random);
    for (int i = 0; i < 3; ++i) sample.twist.angular[i] = any_double(random);
  }
  Sample<clearance_msg_PoseBatch> wire = make_batch(sent.samples.size());
  EXPECT_TRUE(to_wire(sent, *wire));
  PoseBatch received;
  from_wire(*wire, received);
  EXPECT_EQ("arm", received.source.view());
  EXPECT_TRUE(received.sequence_number == 41 && received.scene_revision == 42);
  ASSERT_EQ(sent.samples.size(), received.samples.size());
  const auto same = [](const auto& a, const auto& b) {  // NaN equals itself here
    return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) ==
           0;
  };
  for (std::size_t i = 0; i < sent.samples.size(); ++i) {
    const PoseSample& a = sent.samples[i];
    const PoseSample& b = received.samples[i];
    EXPECT_EQ(a.object, b.object);
    EXPECT_EQ(a.stamp_ns, b.stamp_ns);
    EXPECT_EQ(a.has_twist, b.has_twist);
    EXPECT_TRUE(same(a.world_from_object.position, b.world_from_object.position));
    EXPECT_TRUE(
        same(a.world_from_object.orientation.coeffs(), b.world_from_object.orientation.coeffs()));
    EXPECT_TRUE(same(a.twist.linear, b.twist.linear));
    EXPECT_TRUE(same(a.twist.angular, b.twist.angular));
  }
}

// Equal poses, and those of two times, say nothing else.
TEST(Convert, TwoPosesOfOneObjectAtOneTimeInOneBatchAreNone) {
  PoseBatch sent{SourceName("arm"), 1, 0, std::vector<PoseSample>(7)}, received;
  const int tenths[] = {1, 3, 2, 2, 3, 1, 1}, is_one[] = {0, 1, 0, 1, 1, 0, 0};
  for (std::size_t i = 0; i < 7; ++i) {
    sent.samples[i].object = std::array{2u, 1u, 2u, 2u, 1u, 3u, 3u}[i];
    sent.samples[i].stamp_ns = i == 3;
    sent.samples[i].world_from_object.position.x() = 0.1 * tenths[i];
  }
  sent.samples[6].world_from_object.orientation = Eigen::Quaterniond(0, 1, 0, 0);
  auto wire = make_batch(7);
  EXPECT_TRUE(to_wire(sent, *wire));
  from_wire(*wire, received);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(std::isfinite(received.samples[i].world_from_object.position.x()), is_one[i]);
}

TEST(Convert, BatchIsForTheSceneOfItsRevisionAndForAnyWithoutOne) {
  PoseBatch batch;
  batch.scene_revision = 78;
  EXPECT_FALSE(made_for(batch, 77));
  EXPECT_TRUE(made_for(batch, 78));
  batch.scene_revision = 0;
  EXPECT_TRUE(made_for(batch, 77));
}

TEST(Convert, BatchLargerThanTheRoomIsCutAndSaysSo) {
  Sample<clearance_msg_PoseBatch> wire = make_batch(3);
  EXPECT_FALSE(to_wire({SourceName("arm"), 1, 0, std::vector<PoseSample>(4)}, *wire));
  EXPECT_EQ(3u, wire->poses._length);
}

}  // namespace
}  // namespace clearance::test
