#include "monitor/replay/offline_replay.hpp"

#include <limits>
#include <utility>

#include "monitor/replay/replay_run.hpp"

namespace clearance {
namespace {

// Sets what the replay demands of every scene of the recording, beside what its cell says.
void adapt(const OfflineReplayOptions& options, bool with_gradients, Scene& scene) {
  scene.gradients |= with_gradients;
  if (!options.evaluate_all) return;
  scene.evaluate_all = true;
  scene.budget = std::numeric_limits<std::uint32_t>::max();
}

}  // namespace

// The outline is read first: a file that is no recording is an error rather than a failure.
OfflineReplay replay_offline(const Cell& cell, const std::filesystem::path& recording,
                             const OfflineReplayOptions& options,
                             const std::function<void(const ReplayedTick&)>& on_tick) {
  const auto with_gradients = [&](const RecordingOutline& outlined) {
    // Recorded gradients are compared even where the cell does not ask for them: clearanced
    // --gradients does.
    const bool recorded = options.compare == Comparison::kBits && outlined.has_gradients;
    return options.gradients || (recorded && !cell.scene.gradients);
  };
  Cell first = cell;
  if (is_input_log(recording)) {
    adapt(options, options.gradients, first.scene);
    SceneHistory history(first);
    InputLogOptions log{.joint_topics = options.joint_topics,
                        .joints = options.joints,
                        .with_scenes = first.ros.moveit.any(),
                        .with_sensors = true};
    MoveItChanges moveit(first, [&](Scene& scene) { adapt(options, options.gradients, scene); });
    TickFeed feed(open_input_log(recording, first, log), first.scene,
                  options.tick_hz.value_or(first.scene.rate_hz), options.also_at);
    return ReplayRun(history, feed, options, {}, log.with_scenes ? &moveit : nullptr).run(on_tick);
  }
  const RecordingOutline outlined = outline(recording);
  if (!outlined.error.empty()) {
    OfflineReplay failed;
    failed.error = outlined.error;
    return failed;
  }
  std::vector<std::filesystem::path> files{recording};
  files.insert(files.end(), options.continued_in.begin(), options.continued_in.end());
  const auto adapt_scene = [&](Scene& scene) { adapt(options, with_gradients(outlined), scene); };
  adapt_scene(first.scene);
  // Another cell than that of the recording does not change with it.
  const bool is_recorded =
      outlined.catalogue && (*outlined.catalogue)->scene_revision == first.scene.revision;
  SceneHistory history(first, files, adapt_scene, is_recorded);
  TickFeed feed(files, history, outlined, options.tick_hz.value_or(0.0));
  return ReplayRun(history, feed, options, outlined).run(on_tick);
}

}  // namespace clearance
