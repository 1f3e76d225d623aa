#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include "config/decomposition/convex_parts.hpp"
#include "config/mesh/mesh_file.hpp"
#include "monitor/app/print.hpp"
#include "tools/bench/clocks.hpp"
#include "tools/bench/rows.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance::bench {
namespace {

void split(benchmark::State& state, const TriangleMesh& mesh) {
  for (auto _ : state) {
    const double start = ns_of(CLOCK_PROCESS_CPUTIME_ID);
    const auto made = convex_parts(mesh);
    state.SetIterationTime(1e-9 * (ns_of(CLOCK_PROCESS_CPUTIME_ID) - start));
    if (const auto* refused = std::get_if<ShapeError>(&made)) {
      state.SkipWithError(refused->reason.c_str());
      return;
    }
    const auto& parts = std::get<ConvexParts>(made);
    state.counters["parts"] = static_cast<double>(parts.parts.size());
    state.counters["error_mm"] = 1e3 * parts.error;
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
  }
}

void register_split(const std::string& name, TriangleMesh mesh) {
  benchmark::RegisterBenchmark(
      (fmt::format("parts/{}", name)).c_str(),
      [mesh = std::move(mesh)](benchmark::State& state) { split(state, mesh); })
      ->UseManualTime()
      ->Iterations(1)
      ->Unit(benchmark::kMillisecond);
}

TriangleMesh sheet() {
  TriangleMesh mesh;
  drawn::add_quad({Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0.4, 0.3, 0), Vec3(0, 0.3, 0)}, mesh);
  return mesh;
}

}  // namespace

bool register_splits(const std::vector<std::filesystem::path>& mesh_files) {
  register_split("open_box_of_solids", drawn::crate_of_solids());
  register_split("open_box_of_overlapping_solids", drawn::crate_of_overlapping_solids());
  register_split("open_box", drawn::crate());
  register_split("open_box_of_sheets", drawn::open_box());
  register_split("cup", drawn::cup());
  register_split("torus", drawn::torus());
  register_split("bracket", drawn::bracket());
  register_split("sheet", sheet());
  for (const std::filesystem::path& path : mesh_files) {
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    auto mesh = read_mesh(bytes, path.extension().string());
    if (const auto* fault = std::get_if<MeshFault>(&mesh)) {
      print(stderr, "{}: {}\n", path.string(), fault->reason);
      return false;
    }
    const std::string name = path.parent_path().filename().string() + "-" + path.stem().string();
    register_split(name, std::get<TriangleMesh>(std::move(mesh)));
  }
  return true;
}

}  // namespace clearance::bench
