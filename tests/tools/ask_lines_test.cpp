// Lines of motions that clearance-ask does not understand wholly.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

class AskOfALine : public RunsPrograms {
 protected:
  void SetUp() override {
    write_text(folder / "scara.urdf", kScaraUrdf);
    write_text(folder / "cell.yaml",
               "name: lines\nunits: {length: m, angle: rad}\n"
               "robots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
               "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
               "pairs: [{between: [arm, pin]}]\n");
  }
  // Returns the error of a motion with these further keys; empty: it is answered.
  std::string error(const std::string& more) {
    write_text(path("motion.jsonl"),
               R"({"joints": ["shoulder"], "times_s": [0, 1], "positions": [[-1], [-0.9]], )"
               R"("held": {"elbow": 0, "push": 0})" +
                   more + "}\n");
    run(places::programs() + "/clearance-ask",
        {path("cell.yaml"), path("motion.jsonl"), "--out", path("answers.jsonl")});
    return nlohmann::json::parse(read_text(path("answers.jsonl"))).value("error", "");
  }
};

TEST_F(AskOfALine, NamesAKeyThatNobodyReads) {
  const auto refused = [&](const std::string& more, const std::string& text) {
    const std::string found = error(more);
    EXPECT_NE(found.find(text), std::string::npos) << more << ": " << found;
  };
  EXPECT_EQ(error(""), "");
  refused(R"(, "payload": [])", "did you mean 'payloads'?");
  refused(R"(, "velocites": [[9], [9]])", "did you mean 'velocities'?");
  refused(R"(, "payloads": [{"name": "b", "link": "finger", "sphere": 0.1, "poses": {}}])",
          "the unknown key 'poses' in a payload");
  refused(R"(, "payloads": [{"name": "b", "link": "finger", "sphere": 0.1, "box": [1, 1, 1]}])",
          "several shapes");
  refused(R"(, "contacts": [{"pair": ["finger", "pin"], "depth": 0.1, "til": 1}])",
          "'til' in a contact");
  refused(R"(, "margins": [{"between": ["arm", "pin"], "m": 0.1, "metres": 1}])", "in a margin");
  refused(R"(, "margins": [{"between": ["arm", "pin"], "zone": "z", "m": 0.1}])", "'between'");
  refused(R"(, "profile": {"tolerence": 0.1})", "did you mean 'tolerance'?");
  refused(R"(, "moving": {"pin": {"times_s": [0], "poses": [], "pose": 1}})",
          "motion of an object");
  refused(R"(, "beside": [{"joints": [], "times_s": [], "positions": [], "held": {}}])",
          "'held' in a motion beside");
}

TEST_F(AskOfALine, RefusesListsWithAnEntryTooMany) {
  const auto refused = [&](const std::string& more, const std::string& text) {
    const std::string found = error(more);
    EXPECT_NE(found.find(text), std::string::npos) << more << ": " << found;
  };
  const auto payload = [](const std::string& shape) {
    return R"(, "payloads": [{"name": "b", "link": "finger", )" + shape + "}]";
  };
  refused(payload(R"("box": [1, 1, 1, 9])"), "the box of a payload");
  refused(payload(R"("cylinder": [1, 1, 9])"), "[radius, length]");
  refused(payload(R"("vertices": [[0, 0, 0, 9], [1, 0, 0], [0, 1, 0], [0, 0, 1]])"), "a vertex");
  refused(R"(, "contacts": [{"pair": ["finger", "pin", "a"], "depth": 0.1}])", "of a contact");
  refused(R"(, "profile": {"pair": ["finger", "pin", "a"]})", "of a profile");
  refused(R"(, "margins": [{"between": ["arm", "pin", "a"], "m": 0.1}])", "of a margin");
  refused(R"(, "joints_of_others": {"x": [0, 1, 9]})", "[position, age]");
}

TEST_F(AskOfALine, NamesTheKeyOfAValueThatIsNone) {
  EXPECT_EQ(error(R"(, "velocities": "x")").find("\"velocities\": "), 0u);
  EXPECT_EQ(error(R"(, "others": 3)").find("\"others\": "), 0u);
}

TEST_F(AskOfALine, RefusesAKeyThatStandsTwice) {
  EXPECT_NE(error(R"(, "positions": [[0], [0.1]])").find("\"positions\" again"), std::string::npos);
  EXPECT_NE(error(R"(, "poses": {"a": {}, "a": {}})").find("\"a\" again"), std::string::npos);
  EXPECT_EQ(
      error(R"(, "profile": {"pair": ["finger", "pin"], "tolerance": 0.1}, "margins": [0.1])"), "")
      << "the same key in two objects";
}

TEST_F(AskOfALine, PassesOverKeysThatDescribeTheMotionAndItsTruth) {
  EXPECT_EQ(error(R"(, "id": 7, "kind": "line", "how": "drawn", "nominal": 0.1, "robot": "arm", )"
                  R"("least": {"lo": 0.1}, "first_below": {"0": null}, "evals": [1], "gap": 0)"),
            "");
}

}  // namespace
}  // namespace clearance::test
