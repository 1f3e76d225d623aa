// The project's messages for ROS 2, as DDS carries them. The public packages decode them by the
// definitions that ROS 2 publishes, and must find the intended values. tools/setup --tests installs
// the packages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "monitor/wire/cdr.hpp"
#include "monitor/wire/cyclone_private.hpp"
#include "monitor/wire/ros_messages.hpp"
#include "tests/shared/base64.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

// The samples of a topic as they arrived, undecoded.
class RawTopic {
 public:
  RawTopic(Participant& participant, const RosType& type, const std::string& topic)
      : reader_(participant.ros_reader(type, topic)) {}
  explicit RawTopic(dds_entity_t reader) : reader_(reader) {}

  const std::vector<Bytes>& take() {
    for (;;) {
      ddsi_serdata* sample = nullptr;
      dds_sample_info_t info;
      if (dds_takecdr(reader_, &sample, 1, &info, DDS_ANY_STATE) < 1) return came_;
      if (info.valid_data) {
        Bytes& bytes = came_.emplace_back(ddsi_serdata_size(sample));
        ddsi_serdata_to_ser(sample, 0, bytes.size(), bytes.data());
      }
      ddsi_serdata_unref(sample);
    }
  }

 private:
  dds_entity_t reader_;
  std::vector<Bytes> came_;
};

// The values that the packages decode.
std::vector<json> read_officially(const std::string& type, const std::vector<Bytes>& messages) {
  const ScratchFolder folder;
  std::string lines;
  for (const Bytes& message : messages) lines += type + " " + base64(message) + "\n";
  write_text(folder / "messages.txt", lines);
  const std::string command = "node " + test::places::mcap_js() + "/read_ros.mjs " +
                              test::places::programs() + "/../idl/clearance_msgs/msg < " +
                              (folder / "messages.txt").string();
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string output;
  for (int c = std::getc(pipe); c != EOF; c = std::getc(pipe)) output += static_cast<char>(c);
  EXPECT_EQ(0, pclose(pipe)) << output;
  std::vector<json> values;
  std::istringstream stream(output);
  for (std::string line; std::getline(stream, line);) values.push_back(json::parse(line));
  return values;
}

// The message as Cyclone's generated type represents it.
template <class T>
Sample<T> decoded(const Bytes& message) {
  CdrDecoder decoder;
  Sample<T> sample;
  EXPECT_TRUE(decoder.decode(message, sample));
  return sample;
}

Vec3 vector_of(const json& point) {
  return Vec3(point["x"].get<double>(), point["y"].get<double>(), point["z"].get<double>());
}

class OfficialRosReader : public testing::Test {
 protected:
  DdsOptions dds = own_dds();
  Participant client{dds};
};

// One marker by our decoder and by the official one.
void expect_equal(const visualization_msgs_msg_dds__Marker_& marker, const json& theirs) {
  ASSERT_EQ(marker.ns, theirs["ns"]);
  ASSERT_EQ(marker.type, theirs["type"]);
  ASSERT_EQ(marker.action, theirs["action"]);
  ASSERT_EQ(marker.text, theirs["text"]);
  ASSERT_EQ(marker.header.frame_id, theirs["header"]["frame_id"]);
  ASSERT_EQ(marker.points._length, theirs["points"].size());
  ASSERT_EQ(static_cast<double>(marker.color.a), theirs["color"]["a"]);
  ASSERT_EQ(marker.pose.orientation.w, theirs["pose"]["orientation"]["w"]);
  if (marker.points._length == 0) return;
  const auto& last = marker.points._buffer[marker.points._length - 1];
  ASSERT_EQ(Vec3(last.x, last.y, last.z), vector_of(theirs["points"].back()));
}

// The cell of these tests has two boxes, whose zone is active while they are nearer than 0.3 m.
TEST_F(OfficialRosReader, DecodesMarkersDiagnosticsAndNumbersOfTheDaemon) {
  const CellFile cell(small_cell("official") + "ros2: {diagnostics: true, world_frame: map}\n");
  const Cell read = cell.cell();
  RawTopic markers(client, kRosMarkers, "rt/clearance/markers");
  RawTopic diagnostics(client, kRosDiagnostics, "rt/diagnostics");
  RawTopic minimum(client, kRosFloat64, "rt/clearance/minimum_distance");
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path(), "--ros2", "all"}, dds_arguments(dds)));
  double t = 0.0;
  ASSERT_TRUE(eventually([&] {
    poses.send(t += 1e-3, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return markers.take().size() > 20 && diagnostics.take().size() > 1 &&
           minimum.take().size() > 99;
  })) << daemon.output();

  const std::vector<Bytes> drawn = markers.take(), told = diagnostics.take(),
                           least = minimum.take();
  const std::vector<json> arrays = read_officially("visualization_msgs/MarkerArray", drawn);
  std::size_t lines = 0, bodies = 0;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    const auto ours = decoded<visualization_msgs_msg_dds__MarkerArray_>(drawn[i]);
    ASSERT_EQ(ours->markers._length, arrays[i]["markers"].size());
    for (std::uint32_t k = 0; k < ours->markers._length; ++k) {
      const auto& marker = ours->markers._buffer[k];
      const json& theirs = arrays[i]["markers"][k];
      ASSERT_NO_FATAL_FAILURE(expect_equal(marker, theirs));
      bodies += theirs["ns"] == "bodies" ? 1 : 0;
      if (theirs["ns"] != "lines" || theirs["points"].empty()) continue;
      ++lines;
      EXPECT_EQ(theirs["header"]["frame_id"], "map");
      EXPECT_GT(theirs["header"]["stamp"]["sec"], 1'700'000'000);
    }
  }
  EXPECT_GE(bodies, 3u);
  EXPECT_GT(lines, 0u);

  const std::vector<json> healths = read_officially("diagnostic_msgs/DiagnosticArray", told);
  const json& last = healths.back();
  const auto ours = decoded<diagnostic_msgs_msg_dds__DiagnosticArray_>(told.back());
  ASSERT_EQ(ours->status._length, last["status"].size());
  std::map<std::string, json> by_name;
  for (std::uint32_t i = 0; i < ours->status._length; ++i) {
    const auto& status = ours->status._buffer[i];
    const json& theirs = last["status"][i];
    EXPECT_EQ(status.name, theirs["name"]);
    EXPECT_EQ(status.message, theirs["message"]);
    EXPECT_EQ(status.level, theirs["level"]);
    EXPECT_EQ(status.values._length, theirs["values"].size());
    by_name[theirs["name"]] = theirs;
  }
  EXPECT_EQ(by_name.at("clearance official: poses")["level"], 0);
  EXPECT_EQ(by_name.at("clearance official: poses")["values"][0]["key"], "left");
  EXPECT_EQ(by_name.at("clearance official: zone near")["hardware_id"], "official");

  const std::vector<json> numbers = read_officially("std_msgs/Float64", least);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double value = decoded<std_msgs_msg_dds__Float64_>(least[i])->data;
    if (std::isfinite(value)) {
      EXPECT_EQ(value, numbers[i]["data"]);
    } else {
      EXPECT_EQ("-Infinity", numbers[i]["data"]) << "of the ticks before the first poses";
    }
  }
  // The boxes are about half a box apart from each other and from the floor.
  EXPECT_GT(numbers.back()["data"], 0.1);
  EXPECT_LT(numbers.back()["data"], 3.0);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

// The daemon writes its own topics and the messages from the same samples: their bytes are equal,
// and the packages read in the messages what our decoder reads on the daemon's own topics.
TEST_F(OfficialRosReader, DecodesTheDaemonsReportsAsMessagesByTheGeneratedDefinitions) {
  const CellFile cell(small_cell("messages") + "gradients: true\n");
  const Cell read = cell.cell();
  std::map<TopicKind, RawTopic> messages;
  for (const auto& [kind, type] : kRosMessageTypes) {
    const std::string name = "rt/clearance/" + std::string(topic(kind).key);
    messages.try_emplace(kind, client, type, name);
  }
  RawTopic distances(client.reader(TopicKind::kDistances, read.topics.distances));
  RawTopic catalogue(client.reader(TopicKind::kCatalogue, read.topics.catalogue));
  Poses poses(client, read);
  ChildProcess daemon(kDaemon, with({cell.path(), "--ros2", "messages"}, dds_arguments(dds)));
  double t = 0.0;
  ASSERT_TRUE(eventually([&] {
    poses.send(t += 1e-3, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto come = [&](TopicKind kind) { return messages.at(kind).take().size(); };
    return std::min(come(TopicKind::kDistances), distances.take().size()) > 50 &&
           std::min(come(TopicKind::kHealth), come(TopicKind::kZones)) > 0 &&
           std::min(come(TopicKind::kCatalogue), come(TopicKind::kGradients)) > 0 &&
           !catalogue.take().empty();
  })) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();

  const std::vector<Bytes>&told = messages.at(TopicKind::kDistances).take(),
        &own = distances.take();
  const std::set<Bytes> reports(own.begin(), own.end());
  const auto same =
      std::ranges::count_if(told, [&](const Bytes& each) { return reports.contains(each); });
  EXPECT_GT(same, 40) << told.size() << " messages, " << own.size() << " reports";
  const std::vector<json> values = read_officially("clearance_msgs/Distances", told);
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto ours = decoded<clearance_msg_Distances>(told[i]);
    EXPECT_EQ(ours->cycle, values[i]["cycle"]);
    EXPECT_EQ(ours->queries, values[i]["queries"]);
    ASSERT_EQ(ours->pairs._length, values[i]["pairs"].size());
    for (std::uint32_t k = 0; k < ours->pairs._length; ++k) {
      const json& pair = values[i]["pairs"][k];
      EXPECT_EQ(ours->pairs._buffer[k].pair, pair["pair"]);
      if (std::isfinite(ours->pairs._buffer[k].lower)) {
        EXPECT_EQ(ours->pairs._buffer[k].lower, pair["lower"]);
        EXPECT_EQ(ours->pairs._buffer[k].normal.z, pair["normal"]["z"]);
        EXPECT_EQ(ours->pairs._buffer[k].refresh_age_cycles, pair["refresh_age_cycles"]);
      }
    }
  }
  EXPECT_TRUE(std::ranges::any_of(values, [](const json& each) {
    return !each["sources"].empty() && each["sources"][0]["source"] == "test";
  })) << "some ticks took a batch";

  const std::vector<Bytes>& names = messages.at(TopicKind::kCatalogue).take();
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(names, catalogue.take());
  const json objects = read_officially("clearance_msgs/Catalogue", names)[0]["objects"];
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects[2]["name"], "floor");
  EXPECT_EQ(objects[2]["is_fixed"], true);
  const std::vector<Bytes>& zones = messages.at(TopicKind::kZones).take();
  const auto states = decoded<clearance_msgs_msg_dds__ZoneStates_>(zones.back());
  const json zone = read_officially("clearance_msgs/ZoneStates", zones).back()["zones"][0];
  EXPECT_EQ(zone["name"], "near");
  EXPECT_EQ(zone["active"], states->zones._buffer[0].active);
  EXPECT_EQ(zone["since_cycle"], states->zones._buffer[0].since_cycle);
  const json health =
      read_officially("clearance_msgs/Health", messages.at(TopicKind::kHealth).take()).back();
  EXPECT_EQ(health["inputs"][0]["name"], "left");
  EXPECT_GT(health["cycle"], 0);
  EXPECT_FALSE(messages.at(TopicKind::kGradients).take().empty());
  EXPECT_TRUE(messages.at(TopicKind::kSeparation).take().empty()) << "no zone has 'separation'";
  EXPECT_EQ(read_officially("clearance_msgs/Gradients",
                            messages.at(TopicKind::kGradients).take())[0]["pairs"]
                .size(),
            0u)
      << "no joint moves these pairs";
}

TEST_F(OfficialRosReader, DecodesJointStatesOfTheSimulatedRobot) {
  const std::string urdf = test::places::sources() + "/config/cells/seven_joint_arm/arm.urdf";
  RawTopic states(client, kRosJointState, "rt/arm/joint_states");
  ChildProcess robot(kRobot, with({"--urdf", urdf, "--ros", "/arm/joint_states", "--rate", "200"},
                                  dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] { return states.take().size() > 50; })) << robot.output();
  robot.signal(SIGTERM);
  const std::vector<Bytes> sent = states.take();
  const std::vector<json> values = read_officially("sensor_msgs/JointState", sent);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto ours = decoded<sensor_msgs_msg_dds__JointState_>(sent[i]);
    const json& theirs = values[i];
    EXPECT_EQ(ours->header.stamp.nanosec, theirs["header"]["stamp"]["nanosec"]);
    ASSERT_GE(theirs["name"].size(), 7u);
    ASSERT_EQ(theirs["name"].size(), ours->name._length);
    ASSERT_EQ(theirs["position"].size(), ours->position._length);
    for (std::uint32_t k = 0; k < ours->name._length; ++k) {
      EXPECT_EQ(ours->name._buffer[k], theirs["name"][k]);
      EXPECT_EQ(ours->position._buffer[k], theirs["position"][k]);
    }
  }
  EXPECT_NE(values.front()["position"], values.back()["position"]) << "it moves";
  EXPECT_EQ(values.front()["name"][0], "joint1");
}

}  // namespace
}  // namespace clearance::test
