#include "tools/bench/cells.hpp"

#include <fmt/format.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <system_error>

#include "config/cell/cell_file.hpp"
#include "core/batch.hpp"
#include "core/distance.hpp"
#include "monitor/app/print.hpp"
#include "tools/bench/measure.hpp"
#include "tools/rendering/simulated_world.hpp"
#include "tools/shared/joint_sweep.hpp"

namespace clearance::bench {
namespace {

// A second of motion at 1 kHz.
constexpr int kSteps = 1000;

struct PartPair {
  const ConvexBody* a;
  const ConvexBody* b;
  std::uint32_t object_a, object_b;
  Pose a_in_object, b_in_object;
};

// A cell with its poses at every step and its part pairs, made once per cell.
struct Workload {
  Cell cell;
  std::vector<std::vector<Pose>> world_from_object;  // [step][object]
  std::vector<ObjectPair> object_pairs;              // both have a place at every step
  std::vector<PartPair> pairs;
};

std::vector<PartPair> part_pairs(const Scene& scene, const std::vector<ObjectPair>& of_objects) {
  std::vector<PartPair> pairs;
  for (const ObjectPair& pair : of_objects) {
    for (const Part& a : scene.objects[pair.first].parts) {
      for (const Part& b : scene.objects[pair.second].parts) {
        pairs.push_back(
            {&a.shape, &b.shape, pair.first, pair.second, a.object_from_part, b.object_from_part});
      }
    }
  }
  return pairs;
}

// Objects move as the cell's simulation says, and each joint of a robot swings through its range.
std::shared_ptr<Workload> make_workload(Cell cell) {
  auto load = std::make_shared<Workload>();
  load->cell = std::move(cell);
  const std::size_t objects = load->cell.scene.objects.size();
  SimulatedWorld simulated(
      load->cell,
      [sweep = JointSweep(load->cell.scene)](double t_s, std::vector<JointSample>& joints) {
        sweep.at(t_s, joints);
      },
      {});
  std::vector<bool> placed(objects, true);
  for (int step = 0; step < kSteps; ++step) {
    simulated.place(1e-3 * step);
    std::vector<Pose> world(objects);
    for (std::uint32_t i = 0; i < objects; ++i) {
      if (const auto& pose = simulated.object(i)) {
        world[i] = *pose;
      } else {
        placed[i] = false;
      }
    }
    load->world_from_object.push_back(std::move(world));
  }
  std::ranges::copy_if(load->cell.scene.pairs, std::back_inserter(load->object_pairs),
                       [&](const ObjectPair& p) { return placed[p.first] && placed[p.second]; });
  load->pairs = part_pairs(load->cell.scene, load->object_pairs);
  return load;
}

void time_queries(benchmark::State& state, const Workload& load, bool tracked) {
  std::vector<TrackingState> tracking(load.pairs.size());
  double sum = 0.0, widest = 0.0, nearest = kInfinity;
  std::uint64_t iterations = 0, queries = 0;
  std::size_t step = 0;
  for (auto _ : state) {
    const auto& world = load.world_from_object[step++ % kSteps];
    for (std::size_t i = 0; i < load.pairs.size(); ++i) {
      const PartPair& p = load.pairs[i];
      if (!tracked) tracking[i] = {};
      const DistanceResult r = distance(*p.a, *p.b, compose(world[p.object_a], p.a_in_object),
                                        compose(world[p.object_b], p.b_in_object), tracking[i]);
      sum += r.distance;
      widest = std::max(widest, r.upper - r.lower);
      nearest = std::min(nearest, r.distance);
      iterations += r.iterations;
      ++queries;
    }
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(static_cast<std::int64_t>(queries));
  count_steps(state, static_cast<double>(iterations) / static_cast<double>(queries));
  state.counters["widest_gap"] = widest;
  state.counters["nearest"] = nearest;
  state.counters["ns"] =
      benchmark::Counter(static_cast<double>(queries) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

// All part pairs at once. Each part is placed in the world once per step, not once per pair.
void time_batch(benchmark::State& state, const Workload& load) {
  std::vector<const ConvexBody*> parts;
  std::vector<std::uint32_t> first_part;  // [object]
  for (const Object& object : load.cell.scene.objects) {
    first_part.push_back(static_cast<std::uint32_t>(parts.size()));
    for (const Part& part : object.parts) parts.push_back(&part.shape);
  }
  std::vector<BodyPair> pairs;
  for (const ObjectPair& pair : load.object_pairs) {
    for (std::uint32_t a = 0; a < load.cell.scene.objects[pair.first].parts.size(); ++a) {
      for (std::uint32_t b = 0; b < load.cell.scene.objects[pair.second].parts.size(); ++b) {
        pairs.push_back({first_part[pair.first] + a, first_part[pair.second] + b});
      }
    }
  }
  DistanceBatch batch(parts, pairs);
  std::vector<Pose> world_from_part(parts.size());
  std::size_t step = 0;
  double widest = 0.0;
  for (auto _ : state) {
    const auto& world = load.world_from_object[step++ % kSteps];
    std::size_t part = 0;
    for (std::size_t object = 0; object < world.size(); ++object) {
      for (const Part& p : load.cell.scene.objects[object].parts) {
        world_from_part[part++] = compose(world[object], p.object_from_part);
      }
    }
    for (const DistanceResult& r : batch.evaluate(world_from_part)) {
      widest = std::max(widest, r.upper - r.lower);
    }
  }
  const double queries =
      static_cast<double>(pairs.size()) * static_cast<double>(state.iterations());
  state.counters["widest_gap"] = widest;
  state.counters["ns"] =
      benchmark::Counter(queries * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void register_cell(const std::string& name, Cell cell) {
  const auto load = make_workload(std::move(cell));
  benchmark::RegisterBenchmark((fmt::format("cell/tracked/{}", name)).c_str(),
                               [load](benchmark::State& s) { time_queries(s, *load, true); });
  benchmark::RegisterBenchmark((fmt::format("cell/cold/{}", name)).c_str(),
                               [load](benchmark::State& s) { time_queries(s, *load, false); });
  benchmark::RegisterBenchmark((fmt::format("cell/batch/{}", name)).c_str(),
                               [load](benchmark::State& s) { time_batch(s, *load); });
}

}  // namespace

std::vector<std::filesystem::path> cells_in(const std::filesystem::path& folder) {
  std::set<std::filesystem::path> files;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator(folder, gone)) {
    if (entry.path().extension() == ".yaml") files.insert(entry.path());
  }
  if (gone) {
    print(stderr, "clearance-bench: no rows of cells: {} cannot be read: {}\n", folder.string(),
          gone.message());
  }
  return {files.begin(), files.end()};
}

std::optional<Cell> read_or_say(const std::filesystem::path& file) {
  CellResult cell = read_cell(file);
  if (auto* errors = std::get_if<std::vector<CellError>>(&cell)) {
    for (const CellError& e : *errors) print(stderr, "{}\n", e.text);
    return std::nullopt;
  }
  return std::get<Cell>(std::move(cell));
}

void register_cells(const std::vector<std::filesystem::path>& cells) {
  for (const auto& file : cells) {
    if (auto cell = read_or_say(file)) register_cell(file.stem().string(), std::move(*cell));
  }
}

}  // namespace clearance::bench
