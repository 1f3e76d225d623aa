// The daemon beside a program on Fast DDS, which ROS 2 uses by default. Oracle: the distance of a
// link from a wall, in closed form, after joint states and reports have gone through both.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/shared/places.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

class FastDds : public WatchedDaemon {
 protected:
  void start_partner(const std::vector<std::string>& joints) {
    partner.emplace(places::programs() + "/fast_dds_partner",
                    with({"lo", std::to_string(*dds.domain), dds.partition}, joints));
  }
  // The last message of this topic that the partner has printed; null: none.
  json last(const std::string& topic) const {
    const std::string output = partner->output();
    const std::string end = "\"topic\":\"" + topic + "\"}\n";
    const std::size_t found = output.rfind(end);
    if (found == std::string::npos) return {};
    const std::size_t begin = output.rfind('\n', found) + 1;
    json line = json::parse(output.substr(begin, found + end.size() - begin));
    EXPECT_FALSE(line.contains("error")) << line;
    EXPECT_LT(line.value("left", 9), 4) << "bytes that no field of the definition explains";
    return line["message"];
  }
  std::optional<ChildProcess> partner;
};

// The wall is at x = 5. At the angle 0 the end of the upper link is at 0.9 m, and the finger's at
// 2.1 + 0.05 m.
TEST_F(FastDds, JointStatesPlaceTheRobotAndReportsComeBackAsMessages) {
  watch(
      "name: fast\nunits: {length: m, angle: rad}\nrate_hz: 50\n"
      "robots: [{name: arm, urdf: scara.urdf, age_limit_ms: 1000}]\n"
      "objects:\n"
      "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
      "pairs:\n  - {between: [arm, wall], publish: true}\n"
      "  - {between: [arm, arm], publish: false}\n"
      "zones:\n  - {name: near, between: [finger, wall], enter_below: 2.7, leave_above: 2.8}\n"
      "ros2: {messages: true, minimum_distance: true, diagnostics: true}\n");
  start_partner({"shoulder=0", "elbow=0", "push=0.1"});
  const std::string reports = "rt/clearance/distances";
  // A report names the sources that sent since the last one, and on a busy machine none may have.
  json message;
  ASSERT_TRUE(eventually([&] {
    message = last(reports);
    return message.is_object() && message["unknown"] == 0 && !message["sources"].empty() &&
           last("rt/diagnostics").is_object() && last("rt/clearance/zones").is_array() &&
           last("rt/clearance/minimum_distance").is_number();
  })) << daemon->output()
      << partner->output().substr(0, 2000);
  EXPECT_EQ(message["scene_revision"], scene.revision);
  EXPECT_EQ(message["pairs_total"], scene.pairs.size());
  ASSERT_EQ(message["sources"].size(), 1u);
  EXPECT_EQ(message["sources"][0]["source"], "/joint_states");
  const auto distance_of = [&](const std::string& link) {
    for (const json& each : message["pairs"]) {
      const ObjectPair& of = scene.pairs[each["pair"].get<std::size_t>()];
      if (scene.objects[of.first].name == link || scene.objects[of.second].name == link)
        return each["distance"].get<double>();
    }
    ADD_FAILURE() << link;
    return 0.0;
  };
  EXPECT_NEAR(distance_of("upper"), 5 - 0.9, 1e-12);
  EXPECT_NEAR(distance_of("finger"), 5 - 2.1 - 0.05, 1e-12);
  EXPECT_EQ(message["lower_all"], last("rt/clearance/minimum_distance")) << "nothing moves";
  ASSERT_TRUE(eventually([&] { return last("rt/clearance/zones")[0]["active"] == false; }))
      << "left as soon as 2.85 m is known";
  EXPECT_EQ(last("rt/clearance/zones")[0]["name"], "near");
  EXPECT_EQ(last("rt/clearance/zones")[0]["cause"], 0);
  EXPECT_TRUE(eventually([&] {
    const json told = last("rt/diagnostics")["status"];
    return std::any_of(told.begin(), told.end(), [](const json& each) {
      return each["name"] == "clearance fast: joints of arm" && each["level"] == 0;
    });
  }));
  EXPECT_TRUE(daemon->tells("joints-heard", {"arm"}));
}

}  // namespace
}  // namespace clearance::test
