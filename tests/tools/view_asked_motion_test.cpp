// clearance-view's page draws the motion that a client asks a daemon about.
//
// Oracle: the answer that the client got, and the closed form of an arm that swings past a pin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/client/questions.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(ViewOfAnAskedMotion, DrawsThePathAndTheFirstViolation) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const std::string file = (folder / "cell.yaml").string();
  write_text(
      file,
      "name: asked\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
      "questions: {from: [planner]}\nrobots: [{name: arm, urdf: scara.urdf}]\n"
      "objects: [{name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}]\n"
      "pairs: [{between: [arm, pin], publish: true}, {between: [arm, arm]}]\n");
  const DdsOptions dds = own_dds();
  ChildProcess daemon(kDaemon, with({file}, dds_arguments(dds)));
  const View view(with({file}, dds_arguments(dds)));
  Participant participant(dds);
  RosJoints joints(participant);
  ASSERT_TRUE(joints.is_heard()) << daemon.output();
  PageScript page("asked", {view.page()});
  const auto send = [&] {
    joints.send({"shoulder", "elbow", "push"}, {-1.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
  };
  ASSERT_TRUE(eventually([&] {
    send();
    return page.wrote("ready");
  })) << page.output();
  client::Connection connection(dds);
  client::Questions questions(connection, "planner");
  Question question;
  question.motion = {
      .joints = {"shoulder"}, .times = {0.0, 2.0}, .positions = {-1.0, 0.6}, .velocities = {}};
  question.margins = {0.35};
  std::optional<QuestionResult> result;
  ASSERT_TRUE(eventually([&] {
    send();
    result = questions.ask(question, {}, std::chrono::seconds(10));
    return result && result->done();
  })) << daemon.output();
  EXPECT_EQ(page.wait(std::chrono::seconds(100)), 0) << page.output();
  const std::vector<json> lines = lines_of(page);
  ASSERT_EQ(lines.size(), 3u) << page.output();
  EXPECT_EQ(lines[0]["asked"], nullptr);
  const json& drawn = lines[1];
  const json& asked = drawn["asked"];
  EXPECT_EQ(asked["client"], "planner");
  EXPECT_EQ(asked["upper"], result->upper);
  EXPECT_EQ(asked["frames"].size(), 13u) << "12, and the violation";
  EXPECT_EQ(asked["violation"]["t"], result->margins[0].below_at);
  EXPECT_EQ(asked["violation"]["pair"], json({"pin", "finger"}));
  // Frames begin where the shoulder is at -1 rad: the finger is 2 m away from the origin.
  bool has_finger = false;
  for (const json& link : asked["frames"][0]["links"]) {
    const double x = link[1], y = link[2];
    has_finger = has_finger || std::hypot(x - 2.0 * std::cos(1.0), y + 2.0 * std::sin(1.0)) < 1e-9;
  }
  EXPECT_TRUE(has_finger) << asked["frames"][0];
  ASSERT_EQ(drawn["meshes"].size(), 6u) << "three links, along the path and at the violation";
  EXPECT_EQ(drawn["meshes"][0]["count"], 12);
  EXPECT_EQ(drawn["meshes"][5]["count"], 1);
  EXPECT_NE(drawn["meshes"][0]["colour"], drawn["meshes"][5]["colour"]);
  EXPECT_THAT(drawn["notice"].get<std::string>(), HasSubstr("finger"));
  EXPECT_THAT(drawn["notice"].get<std::string>(), HasSubstr("comes below 350.0 mm"));
  EXPECT_EQ(lines[2]["meshes"], json::array()) << "closed by a click";
  EXPECT_EQ(lines[2]["notice"], "");
  EXPECT_EQ(lines[2]["errors"], json::array());
}

}  // namespace
}  // namespace clearance::test
