// A daemon and programs of another version on one network: each side logs it, and none receives
// garbage.
#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "monitor/client/client.hpp"
#include "monitor/publish/report_writer.hpp"
#include "other_version.h"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/shared/logged.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::test {
namespace {

// A generated type under the name of this build's type, as a build with another IDL has it.
class TypeOf {
 public:
  TypeOf(const dds_topic_descriptor_t& layout, const char* name) {
    std::memcpy(bytes_, &layout, sizeof layout);
    std::memcpy(bytes_ + offsetof(dds_topic_descriptor_t, m_typename), &name, sizeof name);
  }
  [[nodiscard]] const dds_topic_descriptor_t* get() const {
    return reinterpret_cast<const dds_topic_descriptor_t*>(bytes_);
  }

 private:
  alignas(dds_topic_descriptor_t) unsigned char bytes_[sizeof(dds_topic_descriptor_t)];
};

const TypeOf kOlderZone(other_msg_OlderZoneState_desc, "clearance::msg::ZoneState");
const TypeOf kNewerZone(other_msg_NewerZoneState_desc, "clearance::msg::ZoneState");
const TypeOf kNewerBatch(other_msg_NewerPoseBatch_desc, "clearance::msg::PoseBatch");

// Endpoints with types of another version, in a participant like that of any other program.
class Stranger {
 public:
  explicit Stranger(const DdsOptions& dds) : participant_(dds) {
    dds_qos_t* qos = dds_create_qos();
    const char* partition = dds.partition.c_str();
    dds_qset_partition(qos, 1, &partition);
    subscriber_ = dds_create_subscriber(participant_.handle(), qos, nullptr);
    publisher_ = dds_create_publisher(participant_.handle(), qos, nullptr);
    dds_delete_qos(qos);
  }
  dds_entity_t reader(const TypeOf& type, const std::string& name) {
    dds_qos_t* qos = latched();
    const dds_entity_t topic =
        dds_create_topic(participant_.handle(), type.get(), name.c_str(), nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(subscriber_, topic, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(reader, 0);
    return reader;
  }
  dds_entity_t writer(const TypeOf& type, const std::string& name) {
    dds_qos_t* qos = latched();
    const dds_entity_t topic =
        dds_create_topic(participant_.handle(), type.get(), name.c_str(), nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(publisher_, topic, qos, nullptr);
    dds_delete_qos(qos);
    EXPECT_GT(writer, 0);
    return writer;
  }

 private:
  static dds_qos_t* latched() {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    return qos;
  }

  Participant participant_;
  dds_entity_t subscriber_ = 0, publisher_ = 0;
};

Scene zone_cell() {
  Scene scene = cell_of({moving("ball", {ball(0.1)}), fixed("post", {ball(0.1)}, at(1, 0, 0))});
  scene.pairs[0].publish = true;
  scene.zones.push_back(zone_over(scene, 0.3, 0.4));
  return scene;
}

struct PublishingDaemon {
  Cell cell{zone_cell()};
  DdsOptions dds = own_dds();
  Participant participant{dds};
  PoseReader poses{cell, participant};
  ReportQueue queue{cell.scene, {.reports = 16}};
  RecordingHealth recording;
  ReportWriter reports{cell, participant, queue, poses, recording};
  Monitor monitor{cell.scene};

  ~PublishingDaemon() { queue.close(); }
  // Writes the state of every zone.
  void tick() { queue.report(monitor.tick({}, kStart), {}); }
};

std::uint32_t refused_for_its_type(dds_entity_t reader) {
  dds_requested_incompatible_qos_status_t status{};
  dds_get_requested_incompatible_qos_status(reader, &status);
  return status.last_policy_id == DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID
             ? status.total_count
             : 0;
}

TEST(OtherVersion, AClientWithAnOlderOrNewerTypeIsRefusedAndTheLogSaysSo) {
  for (const TypeOf* type : {&kOlderZone, &kNewerZone}) {
    const auto logged = std::make_shared<Logged>();
    const LoggedTo log(logged);
    PublishingDaemon daemon;
    Stranger client(daemon.dds);
    const dds_entity_t reader = client.reader(*type, daemon.cell.topics.zones);
    daemon.tick();
    ASSERT_TRUE(eventually([&] { return refused_for_its_type(reader) > 0; }));
    EXPECT_TRUE(eventually([&] {
      return logged->has(
          "a reader of clearance/zones was built with another version of its type: it gets "
          "nothing");
    }));
    void* sample = nullptr;
    dds_sample_info_t info{};
    EXPECT_EQ(0, dds_take(reader, &sample, &info, 1, 1));
    EXPECT_EQ(0u, matched_writers(reader));
  }
}

TEST(OtherVersion, AWriterOfPosesWithANewerTypeIsNotHeardAndTheLogSaysSo) {
  const auto logged = std::make_shared<Logged>();
  const LoggedTo log(logged);
  PublishingDaemon daemon;
  Stranger robot(daemon.dds);
  const dds_entity_t writer = robot.writer(kNewerBatch, daemon.cell.topics.poses);
  ASSERT_TRUE(eventually([&] {
    dds_offered_incompatible_qos_status_t status{};
    dds_get_offered_incompatible_qos_status(writer, &status);
    return status.last_policy_id == DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID;
  }));
  ASSERT_TRUE(eventually([&] { return logged->has("[other-type-writer]"); }));
  EXPECT_EQ(0u, matched_readers(writer));
}

TEST(OtherVersion, AClientOfThisOneSaysWhyItHearsNothingOfAnother) {
  const DdsOptions dds = own_dds();
  Stranger daemon(dds);
  client::Connection connection(dds);
  client::Reports reports(connection);
  EXPECT_EQ("", reports.refusal());
  // Any other type without a key, under the name of the reports' type.
  const TypeOf type(other_msg_OlderSeparation_desc, "clearance::msg::Distances");
  daemon.writer(type, "clearance/distances");
  ASSERT_TRUE(eventually([&] { return !reports.refusal().empty(); }));
  EXPECT_EQ(
      "clearance/distances is published with another version of its type: rebuild this program "
      "with "
      "the IDL of that daemon",
      reports.refusal());
  EXPECT_FALSE(reports.next());
}

}  // namespace
}  // namespace clearance::test
