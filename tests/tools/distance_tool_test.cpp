// clearance-distance as its users run it: files and pipes in, lines and an exit status out.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;

struct Outcome {
  int status = -1;
  std::string out, err;
  std::vector<Json> lines;
};

class DistanceTool : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* file) const { return (folder_ / file).string(); }

  [[nodiscard]] std::string read(const char* file) const { return test::read_text(path(file)); }

  // `arguments` as a shell reads them; `in` is the standard input.
  Outcome run(const std::string& arguments, const std::string& in = "") {
    std::ofstream(path("in")) << in;
    const std::string command = test::places::programs() + "/clearance-distance " + arguments +
                                " < " + path("in") + " > " + path("out") + " 2> " + path("err");
    const int code = std::system(command.c_str());
    Outcome result;
    result.status = WIFEXITED(code) ? WEXITSTATUS(code) : -1;
    result.out = read("out");
    result.err = read("err");
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      result.lines.push_back(Json::parse(line, nullptr, false));
    }
    return result;
  }

  test::ScratchFolder folder_;
};

constexpr const char* kCube =
    R"({"halfspaces":[[2,0,0,1],[-1,0,0,0.5],[0,1,0,0.5],[0,-1,0,0.5],[0,0,1,0.5],[0,0,-1,0.5]]})";

// `turn`: the quaternion of B.
std::string cubes(const std::string& id, double x, const std::string& turn = "0,0,0,1") {
  std::ostringstream out;
  out << R"({"id":")" << id << R"(","a":)" << kCube << R"(,"b":)" << kCube
      << R"(,"pose_a":{"xyz":[0,0,0]},"pose_b":{"xyz":[)" << x << R"(,0,0],"quaternion":[)" << turn
      << "]}}\n";
  return out.str();
}

TEST_F(DistanceTool, RefusesKeysOfABodyThatItDoesNotReadAndKeysThatStandTwice) {
  const auto error = [&](const std::string& body) {
    const Outcome r = run("--cases - --out -", R"({"id":1,"a":)" + body + R"(,"b":)" + kCube +
                                                   R"(,"pose_a":{"xyz":[0,0,0]},)"
                                                   R"("pose_b":{"xyz":[3,0,0]}})" +
                                                   "\n");
    return r.lines.at(0).value("error", "");
  };
  EXPECT_EQ(error(R"({"vertices":[[0,0,0]],"radius":0.5})"), "");
  EXPECT_NE(error(R"({"vertices":[[0,0,0]],"raduis":0.5})").find("did you mean 'radius'?"),
            std::string::npos);
  EXPECT_NE(error(R"({"cone":{"radius":1,"half_length":1,"height":3}})").find("key 'height'"),
            std::string::npos);
  EXPECT_NE(error(R"({"cone":{"radius":1,"half_length":1},"vertices":[]})").find("'vertices'"),
            std::string::npos);
  EXPECT_NE(error(R"({"vertices":[[0,0,0]],"radius":0.5,"radius":0})").find("\"radius\" again"),
            std::string::npos);
}

TEST_F(DistanceTool, AnswersCasesFromAPipe) {
  const Outcome r = run("--cases - --out -", cubes("first", 1.5) + "\n" + cubes("second", 0.25));
  EXPECT_EQ(r.status, 0) << r.err;
  ASSERT_EQ(r.lines.size(), 2u);
  EXPECT_EQ(r.lines[0]["id"], "first");
  EXPECT_NEAR(r.lines[0]["distance"].get<double>(), 0.5, 1e-15);
  EXPECT_LE(r.lines[0]["lower"].get<double>(), 0.5);
  EXPECT_GE(r.lines[0]["upper"].get<double>(), 0.5);
  EXPECT_EQ(r.lines[0]["status"], "converged");
  EXPECT_NEAR(r.lines[0]["witness_a"][0].get<double>(), 0.5, 1e-15);
  EXPECT_NEAR(r.lines[0]["witness_b"][0].get<double>(), 1.0, 1e-15);
  EXPECT_GE(r.lines[0]["iterations"].get<int>(), 1);
  EXPECT_EQ(r.lines[1]["status"], "overlapping");
  EXPECT_EQ(r.lines[1]["distance"], 0.0);
  EXPECT_EQ(r.lines[1]["lower"], 0.0);
  EXPECT_EQ(r.lines[1]["upper"], 0.0);
  EXPECT_EQ(r.lines[1]["witness_a"], r.lines[1]["witness_b"]);
  EXPECT_NEAR(r.lines[1]["penetration"].get<double>(), 0.75, 1e-15);
  EXPECT_LE(r.lines[1]["penetration_lower"].get<double>(), 0.75);
  EXPECT_GE(r.lines[1]["penetration_upper"].get<double>(), 0.75);
  EXPECT_EQ(r.lines[1]["normal"], Json::array({1.0, 0.0, 0.0}));
  EXPECT_NEAR(r.lines[1]["deepest_a"][0].get<double>(), 0.5, 1e-15);
  EXPECT_NEAR(r.lines[1]["deepest_b"][0].get<double>(), -0.25, 1e-15);
  EXPECT_NE(r.err.find("2 lines, 0 with errors"), std::string::npos) << r.err;
}

TEST_F(DistanceTool, GivesTheDoublesOfTheCoreBackExactly) {
  for (const hard::CaseFamily& family : hard::case_families()) {
    Random random(7);
    const hard::HardCase c = family.make(random);
    const Outcome r = run("--cases - --out -", hard::json_line("x", family.name, c) + "\n");
    ASSERT_EQ(r.lines.size(), 1u);
    ASSERT_TRUE(r.lines[0].contains("distance")) << r.out;
    DistanceJudge judge(c.a, c.b);
    TrackingState state;
    const DistanceResult expected = judge.ask(c.pose_a, c.pose_b, state);
    if (expected.lower == -kInfinity) continue;  // no translation separates them: null
    const bool overlapping = expected.upper < 0.0;
    const double sign = overlapping ? -1.0 : 1.0;
    const char* lower = overlapping ? "penetration_upper" : "lower";
    const char* upper = overlapping ? "penetration_lower" : "upper";
    EXPECT_EQ(sign * r.lines[0][overlapping ? "penetration" : "distance"].get<double>(),
              overlapping ? expected.distance : std::max(0.0, expected.distance))
        << family.name;
    EXPECT_EQ(sign * r.lines[0][lower].get<double>(),
              overlapping ? expected.lower : std::max(0.0, expected.lower))
        << family.name;
    EXPECT_EQ(sign * r.lines[0][upper].get<double>(), expected.upper) << family.name;
    EXPECT_EQ(r.lines[0]["status"], name(expected.status)) << family.name;
    const Vec3 on_a = transform(c.pose_a, expected.point_on_a);
    EXPECT_EQ(r.lines[0]["deepest_a"][2].get<double>(), on_a.z()) << family.name;
  }
}

TEST_F(DistanceTool, SaysNullForABoundThatIsNotKnown) {
  const Outcome r =
      run("--cases - --out -", R"({"id":"corner","a":{"halfspaces":[[0,0,1,0]]},"b":{"halfspaces":)"
                               R"([[1,0,0,0]]},"pose_a":{"xyz":[0,0,0]},"pose_b":{"xyz":[0,0,0]}})"
                               "\n");
  EXPECT_EQ(r.status, 0) << r.err;
  ASSERT_EQ(r.lines.size(), 1u);
  EXPECT_EQ(r.lines[0]["distance"], 0.0);
  EXPECT_EQ(r.lines[0]["penetration_lower"], 0.0);
  EXPECT_TRUE(r.lines[0]["penetration_upper"].is_null()) << "no translation parts them: " << r.out;
  EXPECT_EQ(r.lines[0]["normal"], Json::array({0.0, 0.0, 0.0}));
  EXPECT_TRUE(r.lines[0]["deepest_a"][0].is_number()) << r.out;
}

TEST_F(DistanceTool, PutsTheWitnessPointOfABodyFarFromTheOtherOneOnItToItsOwnRounding) {
  const Outcome r =
      run("--cases - --out -", R"({"id":"far","a":{"vertices":[[0,0,0]],"radius":0.5},)"
                               R"("b":{"vertices":[[0,0,0]],"radius":0.25},)"
                               R"("pose_a":{"xyz":[700,-500,510],"quaternion":[0.1,0.7,0.7,0.1]},)"
                               R"("pose_b":{"xyz":[0.5,0.25,-0.25],"quaternion":[0,0,1,0]}})"
                               "\n");
  ASSERT_EQ(r.lines.size(), 1u) << r.err;
  const Vec3 from_middle(r.lines[0]["witness_b"][0].get<double>() - 0.5,
                         r.lines[0]["witness_b"][1].get<double>() - 0.25,
                         r.lines[0]["witness_b"][2].get<double>() + 0.25);
  EXPECT_NEAR(from_middle.norm(), 0.25, 2e-16);
}

TEST_F(DistanceTool, TracksAMotionAndGivesOneEntryAPose) {
  Random random(5);
  const hard::HardMotion m = hard::motion_families()[0].make(random, 30);
  const std::string line = hard::json_line("motion", "flyby", m) + "\n";
  const Outcome tracked = run("--cases - --out -", line);
  const Outcome cold = run("--cases - --out - --cold", line);
  ASSERT_EQ(tracked.lines.size(), 1u);
  for (const char* key :
       {"distance", "lower", "upper", "witness_a", "witness_b", "status", "iterations"}) {
    EXPECT_EQ(tracked.lines[0][key].size(), 30u) << key;
  }
  DistanceJudge judge(m.a, m.b);
  TrackingState state;
  for (std::size_t k = 0; k < m.poses.size(); ++k) {
    const DistanceResult expected = judge.ask(m.poses[k].first, m.poses[k].second, state);
    EXPECT_EQ(tracked.lines[0]["distance"][k].get<double>(), expected.distance);
    EXPECT_LE(tracked.lines[0]["lower"][k], cold.lines[0]["upper"][k]);
    EXPECT_LE(cold.lines[0]["lower"][k], tracked.lines[0]["upper"][k]);
  }
}

// A single motion may need more: a pose may be far from the one before.
TEST_F(DistanceTool, TrackingTakesFewerIterationsThanColdQueries) {
  Random random(5);
  std::string lines;
  for (int i = 0; i < 12; ++i)
    lines += hard::json_line("motion", "flyby", hard::motion_families()[0].make(random, 30)) + "\n";
  const auto iterations = [&](const char* arguments) {
    int sum = 0;
    for (const auto& line : run(arguments, lines).lines)
      for (const auto& of_pose : line["iterations"]) sum += of_pose.get<int>();
    return sum;
  };
  EXPECT_LT(iterations("--cases - --out -"), iterations("--cases - --out - --cold"));
}

// The cubes are first 0.5 m apart, then 0.25 m deep in each other.
std::string with_exact(std::string line, const std::string& exact) {
  return line.insert(1, exact + ",");
}

TEST_F(DistanceTool, ChecksItsAnswersAgainstExactOnes) {
  const std::string apart = with_exact(cubes("apart", 1.5), R"("distance":"0.5","family":"cubes")");
  const std::string deep = with_exact(
      cubes("deep", 0.75), R"("distance":"0","penetration":"2.5e-1","scale":1,"family":"deep")");
  const Outcome good = run("--cases - --out - --check", apart + deep);
  EXPECT_EQ(good.status, 0) << good.err;
  EXPECT_NE(good.err.find("every bound holds"), std::string::npos) << good.err;
  EXPECT_NE(good.err.find("\ncubes "), std::string::npos) << good.err;

  struct Wrong {
    const char* exact;
    const char* fault;
  };
  for (const Wrong& wrong : {
           Wrong{R"("distance":"0.500001")", "-:1: distance 0.5, exactly 0.500001"},
           Wrong{R"("distance":"0.500001")", "-:1: upper bound 0.5"},
           Wrong{R"("distance":"0.499999")", "-:1: lower bound 0.49999999999999"},
           Wrong{R"("distance":"0.5","penetration":"0.1")", "-:1: penetration 0, exactly 0.1"},
       }) {
    const Outcome r = run("--cases - --out - --check", with_exact(cubes("x", 1.5), wrong.exact));
    EXPECT_EQ(r.status, 1) << wrong.exact;
    EXPECT_NE(r.err.find(wrong.fault), std::string::npos) << r.err;
  }
  const Outcome overlap = run("--cases - --out - --check --tolerance 1",
                              with_exact(cubes("x", 0.75), R"("distance":"0.1")"));
  EXPECT_EQ(overlap.status, 1) << "it says overlapping, the tolerance notwithstanding";
  EXPECT_NE(overlap.err.find("status overlapping, exactly 0.1"), std::string::npos) << overlap.err;
}

// Bounds in doubles cannot differ by a millionth of an ulp.
TEST_F(DistanceTool, ChecksHowFarItsBoundsAreApart) {
  const std::string apart = with_exact(cubes("apart", 1.7), R"("distance":"0.7")");
  const std::string deep =
      with_exact(cubes("deep", 0.7), R"("distance":"0","penetration":"0.3","scale":1)");
  for (const std::string& cube : {apart, deep}) {
    const Outcome r = run("--cases - --out - --check --tolerance 1 --gap 1e-22", cube);
    EXPECT_EQ(r.status, 1);
    EXPECT_NE(r.err.find(" of the bodies' size apart"), std::string::npos) << r.err;
  }
}

TEST_F(DistanceTool, ChecksEveryPoseOfAMotion) {
  std::string line = cubes("motion", 0.0);
  const std::string start = R"({"xyz":[0,0,0]})";
  line.erase(line.find(R"(,"pose_a")"));
  line += R"(,"poses":[[)" + start + R"(,{"xyz":[1.5,0,0]}],[)" + start +
          R"(,{"xyz":[0,0,3]}]],"penetrations":[null,null],"distances":["0.5",)";
  EXPECT_EQ(run("--cases - --out - --check", line + "\"2\"]}\n").status, 0);
  const Outcome wrong = run("--cases - --out - --check", line + "\"2.0000001\"]}\n");
  EXPECT_EQ(wrong.status, 1);
  EXPECT_NE(wrong.err.find("-:1: pose 1: distance 2, exactly 2.0000001"), std::string::npos)
      << wrong.err;
}

TEST_F(DistanceTool, ACheckOfNothingFails) {
  const Outcome none = run("--cases - --out - --check", cubes("x", 1.5));
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("1 line carried no exact answer\nnothing was checked"), std::string::npos)
      << none.err;
  for (const char* bad : {R"("distance":0.5)", R"("distance":"0.5 m")", R"("distances":[])"}) {
    const Outcome r = run("--cases - --out - --check", with_exact(cubes("x", 1.5), bad));
    EXPECT_EQ(r.status, 1) << bad;
  }
  // For two unbounded bodies, only true bounds are promised and checked.
  const std::string half = R"({"halfspaces":[[1,0,0,1]]})";
  const Outcome r = run("--cases - --out - --check",
                        R"({"id":"x","distance":"0","penetration":"1","a":)" + half + R"(,"b":)" +
                            half + R"(,"pose_a":{"xyz":[0,0,0]},"pose_b":{"xyz":[0,0,0]}})");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(run("--cases - --out - --tolerance 1e-9", cubes("x", 1.5)).status, 2);
}

TEST_F(DistanceTool, NamesABadLineAndGoesOn) {
  const std::string bad[] = {
      "{\"id\": 3",
      R"([1, 2])",
      R"({"id":"x","b":{},"pose_a":{},"pose_b":{}})",
      R"({"id":"x","a":{"halfspaces":[[1,0,0]]},"b":{"vertices":[[0,0,0]]}})",
      R"({"id":"x","a":{"halfspaces":[[1,0,0,1],[-1,0,0,-2]]},"b":{"vertices":[[0,0,0]]}})",
      R"({"id":"x","a":{"vertices":[[0,0,0]],"radius":-1},"b":{"vertices":[[0,0,0]]}})",
      R"({"id":"x","a":{"vertices":[[0,0,0]]},"b":{"vertices":[[0,0,0]]},"pose_a":{"xyz":[0,0,0]},"pose_b":{"quaternion":[0,0,0,0]}})",
      R"({"id":"x","a":{"vertices":[[0,0,0]]},"b":{"vertices":[[0,0,0]]},"poses":[[{"xyz":[0,0,0]}]]})",
      R"({"id":"x","a":{"vertices":[[0,0,0]],"radius":1e13},"b":{"vertices":[[0,0,0]]}})",
      R"({"id":"x","a":{"vertices":[[0,0,0]]},"b":{"vertices":[[0,0,0]]},"pose_a":{"xyz":[0,1e13,0]},"pose_b":{"xyz":[0,0,0]}})",
      R"({"id":"x","a":{"vertices":[[0,0,1e999]]},"b":{"vertices":[[0,0,0]]}})",
      R"({"id":"x","a":{"vertices":[[0,0,0]]},"b":{"vertices":[[0,0,0]]},"pose_a":[0,0,0,1,0,0,0]})",
  };
  const char* expected[] = {"not JSON",
                            "not a JSON object",
                            "has no \"a\"",
                            "a.halfspaces[0]: expected [nx, ny, nz, d], found [1,0,0]",
                            "a: the half-spaces",
                            "a.radius: expected a length",
                            "pose_b: the quaternion has length 0; expected 1",
                            "poses[0]: expected [pose_a, pose_b]",
                            "at most 1e12",
                            "pose_a lies more than 1e12 m from the origin",
                            "not JSON",
                            R"(pose_a: expected {"xyz": [x, y, z], "quaternion": [x, y, z, w]})"};
  std::string in = cubes("good", 2.0);
  for (const std::string& line : bad) in += line + "\n";
  in += cubes("also good", 3.0);
  const Outcome r = run("--cases - --out -", in);
  EXPECT_EQ(r.status, 1);
  ASSERT_EQ(r.lines.size(), std::size(bad) + 2);
  EXPECT_EQ(r.lines.front()["id"], "good");
  EXPECT_EQ(r.lines.back()["id"], "also good");
  for (std::size_t k = 0; k < std::size(bad); ++k) {
    EXPECT_EQ(r.lines[k + 1]["line"], k + 2);
    const std::string error = r.lines[k + 1]["error"];
    EXPECT_NE(error.find(expected[k]), std::string::npos) << error;
  }
}

TEST_F(DistanceTool, WorksOnFilesAndRepeatsForTheClock) {
  std::ofstream(path("cases.jsonl")) << cubes("one", 1.5);
  const Outcome r =
      run("--cases " + path("cases.jsonl") + " --out " + path("results.jsonl") + " --repeat 50");
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(Json::parse(read("results.jsonl"))["id"], "one");
  EXPECT_NE(r.err.find("50 queries"), std::string::npos) << r.err;
}

TEST_F(DistanceTool, CountsByWhichPathTheAnswersCame) {
  std::ofstream(path("cases.jsonl")) << cubes("apart", 1.5) << '\n'
                                     << cubes("overlapping", 0.25) << '\n'
                                     << cubes("tilted", 0.25, "0.36,0.48,0,0.8");
  const Outcome r = run("--cases " + path("cases.jsonl") + " --out " + path("results.jsonl"));
  EXPECT_NE(r.err.find("by feature tracking 1, by the active set 1 (1 touch or overlap, 0 by GJK), "
                       "by features that overlap 1"),
            std::string::npos)
      << r.err;
}

TEST_F(DistanceTool, SaysWhatIsWrongWithItsArguments) {
  EXPECT_EQ(run("").status, 2);
  EXPECT_EQ(run("--cases -").status, 2);
  EXPECT_EQ(run("--cases - --out - --repeat 0").status, 2);
  const Outcome missing = run("--cases " + path("nowhere.jsonl") + " --out -");
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.err.find("nowhere.jsonl: No such file"), std::string::npos) << missing.err;
  const Outcome directory = run("--cases " + path("") + " --out -");
  EXPECT_EQ(directory.status, 2);
  EXPECT_NE(directory.err.find("it is a directory"), std::string::npos) << directory.err;
  std::ofstream(path("empty.jsonl")).flush();
  const Outcome empty = run("--cases " + path("empty.jsonl") + " --out - --check");
  EXPECT_EQ(empty.status, 2);
  EXPECT_NE(empty.err.find("holds no case"), std::string::npos) << empty.err;
  std::ofstream(path("broken.jsonl")) << cubes("one", 1.5) << "{\n{\n";
  const Outcome broken = run("--cases " + path("broken.jsonl") + " --out -");
  EXPECT_EQ(broken.status, 1);
  EXPECT_NE(broken.err.find("broken.jsonl:2: not JSON"), std::string::npos) << broken.err;
  EXPECT_EQ(broken.err.find("broken.jsonl:3:"), std::string::npos) << broken.err;
  std::ofstream(path("cases.jsonl")) << cubes("one", 1.5);
  EXPECT_EQ(run("--cases " + path("cases.jsonl") + " --out " + path("cases.jsonl")).status, 2);
  EXPECT_EQ(read("cases.jsonl"), cubes("one", 1.5)) << "the cases are as they were";
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.out.find("Example"), std::string::npos) << help.out;
}

// The example in --help is run unchanged.
TEST_F(DistanceTool, HelpShowsAnExampleThatWorks) {
  const std::string help = run("--help").out;
  const std::size_t start = help.find("  echo '");
  ASSERT_NE(start, std::string::npos);
  std::ofstream(path("example.sh")) << "PATH=" << test::places::programs() << ":$PATH\n"
                                    << help.substr(start);
  const std::string command = "sh " + path("example.sh") + " > " + path("out") + " 2> /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_NEAR(Json::parse(read("out"))["distance"].get<double>(), 0.5, 1e-15);
}

}  // namespace
}  // namespace clearance
