#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>

#include "monitor/daemon/program.hpp"
#include "monitor/pair_name.hpp"
#include "monitor/record/offline_replay.hpp"
#include "monitor/record/recording_reader.hpp"
#include "monitor/record/report_csv.hpp"
#include "monitor/record/report_recorder.hpp"
#include "tools/replay/arguments.hpp"
#include "tools/replay/progress_bar.hpp"

namespace clearance {
namespace {

void say(const std::string& text) { std::fprintf(stderr, "clearance-replay: %s\n", text.c_str()); }

// The cell given, or the one in the recording; its meshes are looked for beside that file.
std::optional<CellResult> find_cell(const ReplayArguments& arguments) {
  if (!arguments.cell.empty()) return read_cell(arguments.cell);
  const RecordingOutline found = outline(arguments.recording);
  if (!found.error.empty()) {
    say(found.error);
    return std::nullopt;
  }
  const char* const yaml = found.catalogue ? (*found.catalogue)->cell_yaml : nullptr;
  if (yaml == nullptr || *yaml == '\0') {
    say("the recording holds no cell: give one with --cell");
    return std::nullopt;
  }
  return parse_cell(yaml, arguments.recording);
}

OfflineReplayOptions options_of(const ReplayArguments& arguments) {
  OfflineReplayOptions options;
  options.start_s = arguments.start_s;
  options.end_s = arguments.end_s;
  if (arguments.compare) options.compare = Comparison::kBits;
  if (arguments.compare_bounds) options.compare = Comparison::kBounds;
  options.reference = arguments.reference;
  options.tolerance = arguments.tolerance;
  options.expect_min_distance = arguments.expect_min_distance;
  options.expect_no_zone = arguments.expect_no_zone;
  return options;
}

void print_summary(const Scene& scene, const OfflineReplay& replay, double tolerance,
                   double elapsed_s) {
  const double recorded_s = static_cast<double>(replay.last_ns - replay.first_ns) * 1e-9;
  std::printf("%llu ticks, %.3f s recorded, replayed in %.3f s (%.0f times as fast)\n",
              static_cast<unsigned long long>(replay.ticks), recorded_s, elapsed_s,
              elapsed_s > 0.0 ? recorded_s / elapsed_s : 0.0);
  if (replay.closest) {
    const PairReport& pair = *replay.closest;
    std::printf("closest: %s, %.9g m (%.9g to %.9g) at %s\n", pair_name(scene, pair).c_str(),
                pair.distance, pair.lower, pair.upper, replay.closest_tick.text().c_str());
  }
  if (replay.compared > 0) {
    std::printf("%llu reports compared\n", static_cast<unsigned long long>(replay.compared));
  }
  if (replay.reference) {
    const ReferenceTotals& totals = *replay.reference;
    std::printf(
        "%llu reference distances compared, largest difference %.2g m; %llu off by more than "
        "%g m, %llu outside of the bounds\n",
        static_cast<unsigned long long>(totals.compared), totals.largest,
        static_cast<unsigned long long>(totals.off), tolerance,
        static_cast<unsigned long long>(totals.outside));
  }
}

int replay_in(Scene& scene, const ReplayArguments& arguments) {
  if (arguments.evaluate_all || !arguments.reference.empty()) {
    scene.evaluate_all = true;
    scene.budget = std::numeric_limits<std::uint32_t>::max();
  }
  std::optional<ReportRecorder> out;
  std::optional<ReportCsv> csv;
  if (!arguments.out.empty()) out.emplace(arguments.out, scene);
  if (!arguments.csv.empty()) csv.emplace(arguments.csv, scene, !arguments.published);
  if (csv && !csv->error().empty()) {
    say(csv->error());
    return kFailed;
  }

  ProgressBar bar(arguments.progress);
  OfflineReplayOptions options = options_of(arguments);
  options.progress = [&bar](double share) { bar.show(share, "replayed"); };
  const auto started = std::chrono::steady_clock::now();
  const OfflineReplay replay =
      replay_offline(scene, arguments.recording, options, [&](const ReplayedTick& tick) {
        if (out) out->add(tick);
        if (csv) csv->add(tick);
      });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  bar.finish();
  std::fputs(replay.text().c_str(), stderr);
  if (!replay.error.empty()) return kFailed;
  print_summary(scene, replay, arguments.tolerance, elapsed.count());

  bool written = true;
  if (out && !out->close()) {
    say(out->error());
    written = false;
  }
  if (csv && !csv->close()) {
    say(csv->error());
    written = false;
  }
  if (!replay.ok() || !written) return kFailed;
  return replay.damage.empty() ? kOk : kIncomplete;
}

bool are_one_file(const std::filesystem::path& first, const std::filesystem::path& second) {
  if (first.empty() || second.empty()) return false;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(first)) ==
         std::filesystem::weakly_canonical(std::filesystem::absolute(second));
}

}  // namespace

int replay_without_dds(const ReplayArguments& arguments) {
  if (are_one_file(arguments.out, arguments.csv)) {
    say("-o and --csv name the same file; expected one for each");
    return kUsage;
  }
  for (const std::string& output : {arguments.out, arguments.csv}) {
    if (!spares_inputs("clearance-replay", output,
                       {arguments.recording, arguments.cell, arguments.reference})) {
      return kUsage;
    }
    if (!may_write("clearance-replay", output, arguments.force)) return kFailed;
  }
  std::optional<CellResult> cell = find_cell(arguments);
  if (!cell) return kFailed;
  std::optional<Scene> scene = scene_or_errors(std::move(*cell));
  if (!scene) {
    if (arguments.cell.empty())
      say("this is the cell as the recording keeps it, without its mesh files; give the cell file "
          "with --cell");
    return kBadCell;
  }
  return replay_in(*scene, arguments);
}

}  // namespace clearance
