// Seeded campaign with damaged files of every kind that a person or a network provides. Cells, URDF
// and SRDF, planning scenes, meshes, pose logs, recordings and cases are mutated and read as the
// programs read them.
//
// Oracle: reading ends, in a value or in a fault with a message. A crash ends the campaign and
// leaves the damaged file in the folder that the program printed. The tests in tests/config define
// good answers.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "config/urdf/planning_scene.hpp"
#include "config/write/robot_cell.hpp"
#include "monitor/recording/csv_recording.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "tests/config/mesh/box_meshes.hpp"
#include "tests/shared/mutation.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tools/cases/case.hpp"

namespace clearance {
namespace {

using test::read_text;
using test::write_text;

// One kind of file: a valid example and its reader. `read` returns whether the file was accepted.
struct Kind {
  std::string name, file, good;
  std::function<bool(const std::filesystem::path& file)> read;
};

const char* const kUrdf = R"(<robot name="little">
  <link name="foot"><collision><geometry><box size="0.4 0.4 0.1"/></geometry></collision></link>
  <link name="mast"><collision><origin xyz="0 0 0.5" rpy="0 0 0.3"/><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
  <link name="head"><collision><geometry><sphere radius="0.12"/></geometry></collision></link>
  <link name="frame"/>
  <joint name="a" type="fixed"><origin xyz="0 0 0.05" rpy="0 0 1.5"/><parent link="foot"/><child link="mast"/></joint>
  <joint name="b" type="revolute"><parent link="mast"/><child link="frame"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="c" type="fixed"><parent link="frame"/><child link="head"/></joint>
</robot>
)";
const char* const kSrdf = R"(<robot name="little">
  <disable_collisions link1="foot" link2="mast" reason="Adjacent"/>
  <disable_collisions link1="head" link2="mast"/>
</robot>
)";
const char* const kCell = R"(name: bench
units: {length: m, angle: rad}
objects:
  - {name: hand, sphere: {radius: 0.1}}
  - {name: box, fixed: true, box: {size: [0.2, 0.2, 0.2]}}
pairs:
  - {between: [hand, box]}
zones: [{name: stop, between: [hand, box], enter_below: 0.1, leave_above: 0.2}]
)";
const char* const kRobotCell = R"(name: bench
units: {length: m, angle: rad}
robots: [{name: little, urdf: robot.urdf}]
pairs: [{between: [little, little]}]
)";
const char* const kScene = R"(shelf
* board
0 0 1
0 0 0 1
2
box
2 1 0.1
0 0 0
0 0 0 1
0.2 0.4 0.6 0.8
mesh
4 4
0 0 0
0.1 0 0
0 0.1 0
0 0 0.1
0 2 1
0 1 3
0 3 2
1 2 3
0 0 0
0 0 0 1
0 0 0 0
1
grasp
0 0 0.1
0 0 0 1
.
)";
const char* const kCase =
    R"({"id": 1, "a": {"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]]}, "b": {"halfspaces": [[1,0,0,1],[-1,0,0,1],[0,1,0,1],[0,-1,0,1],[0,0,1,1],[0,0,-1,1]], "radius": 0.5}, "pose_a": {"xyz": [0,0,0], "quaternion": [0,0,0,1]}, "pose_b": {"xyz": [3,0,0]}})";

std::string pose_log() {
  std::string log = "t_ns,object,px,py,pz,qw,qx,qy,qz\n";
  for (int tick = 1; tick <= 20; ++tick) {
    log += std::to_string(tick * 1'000'000) + ",hand,0," + std::to_string(0.01 * tick) +
           ",1,1,0,0,0\n";
  }
  return log;
}

bool is_cell(const std::filesystem::path& file) {
  return std::holds_alternative<Cell>(read_cell(file));
}

bool is_robot(const std::filesystem::path& urdf, const std::filesystem::path& srdf) {
  RobotCellOptions options;
  options.urdf = urdf;
  options.srdf = srdf;
  options.directory = urdf.parent_path();
  const auto cell = robot_cell(options);
  const auto* good = std::get_if<RobotCell>(&cell);
  if (good != nullptr) static_cast<void>(parse_cell(good->yaml, urdf));
  return good != nullptr;
}

bool is_case(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_case(nlohmann::json::parse(read_text(file))));
    return true;
  } catch (const BadLine&) {
  } catch (const nlohmann::json::exception&) {
  }
  return false;
}

std::vector<Kind> kinds(const test::ScratchFolder& folder) {
  const Cell cell = std::get<Cell>(parse_cell(kCell, "cell.yaml"));
  write_text(folder / "good.urdf", kUrdf);
  write_text(folder / "good.srdf", kSrdf);
  write_text(folder / "good.csv", pose_log());
  static_cast<void>(record_csv(folder / "good.csv", folder / "good.mcap", &cell));
  const std::string cells = test::places::sources() + "/config/cells/";
  std::vector<Kind> all = {
      {"cell", "cell.yaml", read_text(cells + "mcintyre.yaml"), is_cell},
      {"cell with zones", "cell.yaml", kCell, is_cell},
      {"urdf", "robot.urdf", kUrdf,
       [&](const auto& file) { return is_robot(file, folder / "good.srdf"); }},
      {"srdf", "robot.srdf", kSrdf,
       [&](const auto& file) { return is_robot(folder / "good.urdf", file); }},
      {"urdf of a cell", "robot.urdf", kUrdf,
       [&folder](const auto&) {
         return std::holds_alternative<Cell>(parse_cell(kRobotCell, folder / "cell.yaml"));
       }},
      {"planning scene", "shelf.scene", kScene,
       [](const auto& file) {
         return std::holds_alternative<PlanningScene>(read_planning_scene(read_text(file)));
       }},
      {"pose log", "log.csv", pose_log(),
       [&folder, cell](const auto& file) {
         return record_csv(file, folder / "out.mcap", &cell).error.empty();
       }},
      {"recording", "run.mcap", read_text(folder / "good.mcap"),
       [cell](const auto& file) { return replay_offline(cell, file).error.empty(); }},
      {"case", "case.json", kCase, is_case}};
  for (const BoxMesh& mesh : box_meshes()) {
    const std::string file = "mesh." + mesh.extension;
    const std::string cell =
        "name: m\nunits: {length: m, angle: rad}\nobjects:\n  - {name: a, mesh: "
        "{file: " +
        file +
        ", max_parts: 1}}\n  - {name: b, sphere: {radius: 1}}\n"
        "pairs: [{between: [a, b]}]\n";
    all.push_back({mesh.name, file, mesh.bytes, [cell](const auto& at) {
                     return std::holds_alternative<Cell>(parse_cell(cell, at));
                   }});
  }
  return all;
}

// Returns false if the valid file itself was not accepted.
bool run(const Kind& kind, const test::ScratchFolder& folder, std::uint64_t first,
         std::uint64_t count) {
  const std::filesystem::path file = folder / kind.file;
  write_text(file, kind.good);
  if (!kind.read(file)) {
    std::printf("%-16s the file is not taken even when whole\n", kind.name.c_str());
    return false;
  }
  std::uint64_t taken = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    std::mt19937 random(static_cast<std::uint32_t>(seed));
    write_text(file, test::mutated_numbers(kind.good, random));
    taken += kind.read(file) ? 1 : 0;
  }
  std::printf("%-16s %llu mutations, %llu taken, the others refused\n", kind.name.c_str(),
              static_cast<unsigned long long>(count), static_cast<unsigned long long>(taken));
  std::fflush(stdout);
  return true;
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(
        stderr,
        "usage: campaign_files FIRST_SEED MUTATIONS [KIND]\n"
        "MUTATIONS damaged files of each kind, or of one. example: campaign_files 0 2000\n");
    return 2;
  }
  const std::uint64_t first = std::strtoull(argv[1], nullptr, 10),
                      count = std::strtoull(argv[2], nullptr, 10);
  const clearance::test::ScratchFolder folder;
  std::printf("in %s\n", (folder / "").c_str());
  std::fflush(stdout);
  bool good = true;
  for (const clearance::Kind& kind : clearance::kinds(folder)) {
    if (argc < 4 || kind.name == argv[3]) good = run(kind, folder, first, count) && good;
  }
  return good ? 0 : 1;
}
