#include "tools/ask/bag_inputs.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/read_inputs.hpp"

namespace clearance {
namespace {

// Copies of the frames in use: the replay builds others in their place.
class Frames {
 public:
  std::vector<SeenFrame> of(const Scene& scene, const Monitor& monitor) {
    last_.resize(scene.sensors.size());
    std::vector<SeenFrame> frames;
    for (std::uint32_t i = 0; i < scene.sensors.size(); ++i) {
      const SensorFrame frame = monitor.frame_in_use(i);
      if (frame.cloud == nullptr) continue;
      Last& last = last_[i];
      if (last.copy == nullptr || last.stamp_ns != frame.stamp_ns) {
        last = {frame.stamp_ns, std::make_shared<const SeenCloud>(*frame.cloud)};
      }
      frames.push_back({.sensor = scene.sensors[i].name,
                        .cloud = last.copy,
                        .world_from_sensor = frame.world_from_sensor,
                        .pose_error = frame.pose_error});
    }
    return frames;
  }
  void forget() { last_.clear(); }

 private:
  struct Last {
    std::int64_t stamp_ns = 0;
    std::shared_ptr<const SeenCloud> copy;
  };
  std::vector<Last> last_;  // by sensor
};

}  // namespace

std::string for_each_inputs(const Cell& cell, const std::filesystem::path& bag,
                            std::span<const BagMotion> motions, const UseInputs& use) {
  std::size_t next = 0;
  std::uint64_t revision = 0;
  InputState state;
  Frames frames;
  OfflineReplayOptions options;
  std::vector<std::int64_t>& times = options.also_at;
  for (const BagMotion& motion : motions) times.push_back(motion.time_ns(cell.ros.use_sim_time));
  options.stop = [&] { return next == motions.size(); };
  const OfflineReplay replay = replay_offline(cell, bag, options, [&](const ReplayedTick& tick) {
    const Scene& scene = tick.cell.scene;
    if (revision != scene.revision) {
      revision = scene.revision;
      state = room_for_inputs(scene);
      frames.forget();
    }
    if (next == motions.size() || tick.report.now_ns < times[next]) return;
    state.cycle = tick.report.cycle;
    state.now_ns = tick.report.now_ns;
    read_inputs(tick.monitor, state);
    const std::vector<SeenFrame> seen = frames.of(scene, tick.monitor);
    for (; next < motions.size() && times[next] <= tick.report.now_ns; ++next)
      use(next, {tick.cell, state, seen});
  });
  return replay.error;
}

}  // namespace clearance
