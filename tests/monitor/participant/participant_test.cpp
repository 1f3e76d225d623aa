// The configuration of Cyclone.
#include "monitor/participant/participant.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "monitor/participant/domain_configuration.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(Participant, SendsWholeBatchesAsOneDatagramOnLoopback) {
  const std::string xml = domain_configuration({.interface = "lo"});
  EXPECT_THAT(xml, HasSubstr("<MaxMessageSize>65000B</MaxMessageSize>"));
  EXPECT_THAT(xml, HasSubstr("<FragmentSize>64000B</FragmentSize>"));
}

TEST(Participant, SendsNothingThatIpWouldCutOnANetwork) {
  const std::string xml = domain_configuration({.interface = "eth0", .peers = {"10.0.0.2"}});
  EXPECT_THAT(xml, HasSubstr("<NetworkInterface name=\"eth0\"/>"));
  EXPECT_THAT(xml, HasSubstr("<MaxMessageSize>1400B</MaxMessageSize>"));
  EXPECT_THAT(xml, HasSubstr("<FragmentSize>1300B</FragmentSize>"));
  EXPECT_THAT(xml, HasSubstr("<Peer Address=\"10.0.0.2\"/>"));
  EXPECT_THAT(xml, Not(HasSubstr("127.0.0.1")));
}

TEST(Participant, LeavesTheLastWordToCyclonesOwnVariable) {
  ::setenv("CYCLONEDDS_URI", "<General><MaxMessageSize>9000B</MaxMessageSize></General>", 1);
  const std::string xml = domain_configuration({.interface = "eth0"});
  ::unsetenv("CYCLONEDDS_URI");
  EXPECT_GT(xml.find("9000B"), xml.find("1400B"));
  EXPECT_LT(xml.find("9000B"), xml.size());
}

// Cyclone refuses a card that the person's settings and ours both name.
TEST(Participant, NamesNoCardIfOneOfSeveralFilesDoes) {
  const test::ScratchFolder folder;
  test::write_text(folder / "cards.xml",
                   "<Interfaces><NetworkInterface name=\"eth1\"/></Interfaces>");
  test::write_text(folder / "other.xml", "<Tracing/>");
  const auto names = [&](const std::string& first, const std::string& second) {
    const std::string files =
        "file://" + (folder / first).string() + ",file://" + (folder / second).string();
    ::setenv("CYCLONEDDS_URI", files.c_str(), 1);
    const std::string xml = domain_configuration({.interface = "eth0"});
    ::unsetenv("CYCLONEDDS_URI");
    return xml.find("NetworkInterface") != std::string::npos;
  };
  EXPECT_TRUE(names("other.xml", "other.xml"));
  EXPECT_FALSE(names("cards.xml", "other.xml"));
  EXPECT_FALSE(names("other.xml", "cards.xml"));
}

class RosDomain : public testing::Test {
 protected:
  ~RosDomain() override {
    before ? ::setenv("ROS_DOMAIN_ID", before->c_str(), 1) : ::unsetenv("ROS_DOMAIN_ID");
  }
  static std::string where(const char* of_ros, std::optional<std::uint32_t> stated = {}) {
    ::setenv("ROS_DOMAIN_ID", of_ros, 1);
    DdsOptions options = test::own_dds();
    options.domain = stated;
    return Participant(options).where();
  }

 private:
  std::optional<std::string> before =
      std::getenv("ROS_DOMAIN_ID") == nullptr
          ? std::nullopt
          : std::optional<std::string>(std::getenv("ROS_DOMAIN_ID"));
};

TEST_F(RosDomain, IsJoinedWhereNoOptionStatesADomain) {
  EXPECT_THAT(where("77"), StartsWith("domain 77 (of ROS_DOMAIN_ID), partition test-"));
  EXPECT_THAT(where("0"), StartsWith("domain 0 (of ROS_DOMAIN_ID), "));
  EXPECT_THAT(where(""), StartsWith("domain 0, "));
  EXPECT_THAT(where("77", 78), StartsWith("domain 78, "));
  EXPECT_THAT(where("77", 0), StartsWith("domain 0, "));
  EXPECT_THAT(where("nonsense", 78), StartsWith("domain 78, ")) << "it does not matter here";
}

TEST_F(RosDomain, IsRefusedWhereItIsNone) {
  for (const char* text : {"233", "-1", "7x", " 7", "1e1", "0x7", "99999999999999999999"}) {
    try {
      const std::string joined = where(text);
      ADD_FAILURE() << "'" << text << "' joins " << joined;
    } catch (const DdsError& error) {
      EXPECT_THAT(error.what(), HasSubstr("found ROS_DOMAIN_ID='" + std::string(text) +
                                          "'; expected a domain, 0 to 232"));
    }
  }
}

// The number of this participant's endpoints in a topic of discovery, and of those without
// USER_DATA.
std::pair<int, int> endpoints(const Participant& of, dds_entity_t discovery) {
  dds_guid_t own{};
  dds_get_guid(of.handle(), &own);
  const dds_entity_t reader = dds_create_reader(of.handle(), discovery, nullptr, nullptr);
  std::pair<int, int> count{0, 0};
  void* sample = nullptr;
  dds_sample_info_t info{};
  while (dds_take(reader, &sample, &info, 1, 1) == 1) {
    const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(sample);
    void* bytes = nullptr;
    std::size_t size = 0;
    const bool has_data = dds_qget_userdata(endpoint.qos, &bytes, &size) && size > 0;
    dds_free(bytes);
    const bool is_of_discovery = std::string_view(endpoint.topic_name).starts_with("DCPS");
    if (!is_of_discovery && std::ranges::equal(endpoint.participant_key.v, own.v)) {
      ++count.first;
      count.second += has_data ? 0 : 1;
    }
    dds_return_loan(reader, &sample, 1);
  }
  dds_delete(reader);
  return count;
}

TEST(Participant, GivesEveryEndpointUserDataSoThatNoRosNodeWarnsOfIt) {
  Participant participant(test::own_dds());
  for (const Topic& row : kTopics) {
    participant.reader(row.kind, Topics().*row.name);
    participant.reader_of_several(row.kind, Topics().*row.name);
    participant.partner_reader(row.kind, Topics().*row.name);
    participant.writer(row.kind, Topics().*row.name);
  }
  participant.reader_of_others("clearance/distances", nullptr);
  participant.ros_reader(kRosJointState, "rt/joint_states");
  participant.ros_writer(kRosFloat64, "rt/clearance/minimum_distance");
  const int topics = static_cast<int>(kTopics.size());
  EXPECT_EQ(endpoints(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION), std::pair(topics + 1, 0));
  EXPECT_EQ(endpoints(participant, DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION),
            std::pair(3 * topics + 2, 0));
}

// rmw_cyclonedds configures the domain so in a process of ROS 2.
TEST(Participant, JoinsADomainThatAnotherLibraryOfTheProcessHasConfigured) {
  const DdsOptions dds = test::own_dds();
  const dds_entity_t domain =
      check_dds(dds_create_domain(*dds.domain, domain_configuration(dds).c_str()), "configuring");
  {
    Participant theirs(check_dds(dds_create_participant(*dds.domain, nullptr, nullptr), "joining"),
                       dds.partition);
    Participant ours(dds), second(dds);
    EXPECT_THAT(second.where(), HasSubstr("beside another library of this process"));
    const dds_entity_t writer = ours.writer(TopicKind::kPoses, "poses");
    theirs.reader(TopicKind::kPoses, "poses");
    second.reader(TopicKind::kPoses, "poses");
    EXPECT_TRUE(test::eventually([&] { return test::matched_readers(writer) == 2; }));
    EXPECT_EQ(ours.address("poses"), theirs.address("poses"));
    EXPECT_EQ(second.address("poses"), Participant(ours.handle(), dds.partition).address("poses"));
  }
  dds_delete(domain);
}

TEST(Participant, SaysHowLargeItsDatagramsAre) {
  const Participant participant(test::own_dds());
  EXPECT_THAT(participant.where(), HasSubstr("interface lo, datagrams of up to 65000 B"));
}

}  // namespace
}  // namespace clearance
