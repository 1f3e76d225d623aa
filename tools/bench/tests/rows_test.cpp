// The names and counters in the rows of clearance-bench and clearance-thesis, which scripts read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "monitor/files/build_info.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"

namespace clearance {
namespace {

const std::string kBench = CLEARANCE_BENCH_BIN "/clearance-bench";
const std::string kThesis = CLEARANCE_BENCH_BIN "/clearance-thesis";

std::set<std::string> names(const std::string& program) {
  test::ChildProcess bench(program, {"--benchmark_list_tests"});
  EXPECT_EQ(bench.wait(), 0) << bench.output();
  std::istringstream lines(bench.output());
  std::set<std::string> out;
  for (std::string line; std::getline(lines, line);) out.insert(line);
  return out;
}

// The rows as JSON contains them.
nlohmann::json rows_of(const std::string& filter, const std::vector<std::string>& more = {}) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "rows.json").string();
  std::vector<std::string> words{"--benchmark_filter=" + filter, "--benchmark_min_time=0.001",
                                 "--benchmark_out=" + file, "--benchmark_out_format=json"};
  words.insert(words.end(), more.begin(), more.end());
  test::ChildProcess bench(kBench, words);
  EXPECT_EQ(bench.wait(), 0) << bench.output();
  return nlohmann::json::parse(std::ifstream(file)).at("benchmarks");
}

TEST(BenchRows, HaveTheNamesThatAreAnInterface) {
  const std::set<std::string> there = names(kBench), thesis = names(kThesis);
  for (const char* kind : {"f", "v"}) {
    for (const char* order : {"2", "4", "6", "8", "10", "15", "20", "30", "40"}) {
      for (const std::string how : {"tracked/", "cold/"}) {
        EXPECT_TRUE(there.contains(how + kind + order)) << how << kind << order;
      }
      const std::string variant = std::string("variant/base/tracked/") + kind + order;
      EXPECT_TRUE(thesis.contains(variant)) << variant;
    }
  }
  for (const char* peer : {"fcl", "fcl-tight", "fcl-gjk", "bullet", "libccd", "qp"}) {
    for (const std::string load : {"tracked/f2", "cold/v40", "tracked/parallel-boxes"}) {
      EXPECT_TRUE(there.contains("peer/" + (peer + ("/" + load)))) << peer << load;
    }
  }
  for (const char* name :
       {"tracked/boxes", "tracked/parallel-boxes", "cold/links", "overlap/tracked/boxes/middle",
        "cell/tracked/two_arms", "cell/batch/two_arms",
        "robot/kinematics/seven_joint_arms/iterations:20000/manual_time"}) {
    EXPECT_TRUE(there.contains(name)) << name;
  }
  for (const char* name :
       {"tracked/f2", "interval/100/f2", "variant/base/interval/100/f2", "peer/qp/cold/f40",
        "variant/moved-before/tracked/f2", "adjacency/walk/f2", "adjacency/core/f2",
        "adjacency/qhull/f2", "ellipsoids/ours/0.5", "ellipsoids/fcl/0.5"}) {
    EXPECT_TRUE(thesis.contains(name)) << name;
  }
}

TEST(BenchRows, SayTimeErrorAndFailuresInJson) {
  const nlohmann::json rows = rows_of("^(tracked|cold)/boxes$");
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_GT(row.at("ns").get<double>(), 0.0);
    EXPECT_GT(row.at("max_error").get<double>(), 0.0);
    EXPECT_LT(row.at("max_error").get<double>(), 1e-14);
    EXPECT_LT(row.at("widest_gap").get<double>(), 1e-13);
    EXPECT_EQ(row.at("failures").get<double>(), 0.0);
    EXPECT_EQ(row.at("steps"), row.at("iterations"));
    EXPECT_GE(row.at("iterations").get<double>(), 1.0);
    EXPECT_LT(row.at("iterations").get<double>(), 10.0);
  }
}

TEST(BenchRows, SayErrorAndFailuresOfPeersThatMeasure) {
  const nlohmann::json rows = rows_of("^peer/.*/tracked/boxes$");
  ASSERT_EQ(rows.size(), 6u);
  for (const auto& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_GT(row.at("ns").get<double>(), 0.0);
    EXPECT_LT(row.at("failures").get<double>(), 40.0);
    EXPECT_EQ(row.contains("max_error"), row.at("name") != "peer/libccd/tracked/boxes");
  }
}

// The foot is 0.9 m below the hand, however the joint between them turns.
constexpr const char* kPost = R"(<robot name="post">
  <link name="foot"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="pole"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="hand"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <joint name="turn" type="revolute"><origin xyz="0 0 0.5"/><parent link="foot"/><child link="pole"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" velocity="1"/></joint>
  <joint name="top" type="fixed"><origin xyz="0 0 0.5"/><parent link="pole"/><child link="hand"/></joint>
</robot>
)";

TEST(BenchRows, OfCellsHaveTheLinksOfRobotsWhereTheirJointsPlaceThem) {
  const test::ScratchFolder folder;
  std::ofstream(folder / "post.urdf") << kPost;
  std::ofstream(folder / "post.yaml") << "name: post\nunits: {length: m, angle: rad}\n"
                                         "robots: [{name: post, urdf: post.urdf}]\n"
                                         "pairs: [{between: [post, post]}]\n";
  const nlohmann::json rows =
      rows_of("^cell/(tracked|cold)/post$", {"--cell", (folder / "post.yaml").string()});
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) EXPECT_NEAR(row.at("nearest").get<double>(), 0.9, 1e-12);
}

// Tests the script that makes the pages in tools/bench/measured.
TEST(BenchReport, ShowsTheRowsOfTheJsonThatItIsGiven) {
  const test::ScratchFolder folder;
  const std::string file = (folder / "rows.json").string();
  test::ChildProcess bench(
      kBench, {"--benchmark_filter=^(tracked|peer/qp/tracked)/f2$", "--benchmark_min_time=0.001",
               "--benchmark_out=" + file, "--benchmark_out_format=json"});
  ASSERT_EQ(bench.wait(), 0) << bench.output();
  test::ChildProcess report("/usr/bin/env",
                            {"python3", test::places::sources() + "/tools/bench/report",
                             (folder / "").string(), "queries", "--json", file});
  ASSERT_EQ(report.wait(), 0) << report.output();
  const std::string tables = test::read_text(folder / "report.md");
  EXPECT_THAT(tables, testing::HasSubstr("## Tracked, against peers"));
  EXPECT_THAT(tables, testing::ContainsRegex("[|] f2 [|] [0-9]+ [|] 4e-15 [|] 0 [|]"));
  EXPECT_THAT(tables, testing::HasSubstr(std::string("Made from ") + kBuild));
  EXPECT_THAT(test::read_text(folder / "pareto.svg"), testing::HasSubstr("</svg>"));
}

}  // namespace
}  // namespace clearance
