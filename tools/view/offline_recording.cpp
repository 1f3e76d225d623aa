#include "tools/view/offline_recording.hpp"

#include <optional>
#include <vector>

#include "monitor/recording/recorder.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance::view {
namespace {

// The source under which the poses in use are written: all poses that changed in a tick.
constexpr std::string_view kSource = "replay";

class Copy {
 public:
  Copy(const Cell& cell, std::filesystem::path out)
      : cell_(cell), out_(std::move(out)), stamps_(cell.scene.objects.size()) {}

  void add(const ReplayedTick& tick) {
    if (!recorder_) recorder_.emplace(out_, cell_, tick.report.now_ns, RecordingOptions{});
    if (tick.cell.scene.revision != revision_) {
      recorder_->change(tick.cell, tick.since);
      revision_ = tick.cell.scene.revision;
      stamps_.assign(tick.cell.scene.objects.size(), 0);
    }
    recorder_->poses(moved_in(tick.monitor));
    const SourceUse used{batch_.source, batch_.sequence_number};
    recorder_->report(tick.report, {&used, 1});
  }
  [[nodiscard]] std::string close() {
    return !recorder_ || recorder_->close() ? "" : recorder_->error();
  }

 private:
  const PoseBatch& moved_in(const Monitor& monitor) {
    batch_.source = SourceName(kSource);
    ++batch_.sequence_number;
    batch_.scene_revision = revision_;
    batch_.samples.clear();
    for (std::uint32_t i = 0; i < stamps_.size(); ++i) {
      const std::int64_t stamp_ns = monitor.stamp_ns(i);
      if (stamp_ns == stamps_[i]) continue;
      stamps_[i] = stamp_ns;
      PoseSample& sample = batch_.samples.emplace_back();
      sample.object = i;
      sample.stamp_ns = stamp_ns;
      sample.world_from_object = monitor.pose(i);
    }
    return batch_;
  }

  const Cell& cell_;
  std::uint64_t revision_ = cell_.scene.revision;  // of the last tick
  std::filesystem::path out_;
  std::optional<Recorder> recorder_;
  std::vector<std::int64_t> stamps_;  // the poses written last
  PoseBatch batch_{};
};

}  // namespace

std::string replay_into(const Cell& cell, const std::filesystem::path& recording,
                        const std::filesystem::path& out,
                        const std::function<void(double)>& progress,
                        const std::function<bool()>& stop) {
  OfflineReplayOptions options;
  options.progress = progress;
  options.stop = stop;
  Copy copy(cell, out);
  const OfflineReplay replay = replay_offline(
      cell, recording, options, [&copy](const ReplayedTick& tick) { copy.add(tick); });
  if (!replay.error.empty()) return replay.error;
  return copy.close();
}

}  // namespace clearance::view
