// The channels of a recording that 3D viewers draw: bodies once per file, transforms and closest
// pairs of some reports.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "monitor/intake/own_batches.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/visual/cell_markers.hpp"
#include "monitor/visual/object_poses.hpp"
#include "monitor/visual/ros_types.hpp"
#include "monitor/wire/cdr.hpp"

namespace clearance {

class SceneChannels {
 public:
  // Writes the bodies. `scene` must outlive it, or the next change(), and `writer` must outlive it.
  SceneChannels(const Scene& scene, RecordingWriter& writer, std::int64_t now_ns)
      : scene_(&scene),
        writer_(writer),
        poses_(std::make_unique<ObjectPoses>(scene)),
        own_(std::make_unique<OwnBatches>(scene)),
        transforms_(writer.add_channel(ros::transforms_schema(), kTransformsTopic)),
        closest_(writer.add_channel(ros::markers_schema(), kClosestTopic)),
        bodies_(writer.add_channel(ros::markers_schema(), kBodiesTopic)) {
    write_bodies(now_ns);
  }

  // Every file needs this.
  void write_bodies(std::int64_t now_ns) { write(bodies_, now_ns, bodies_message(*scene_)); }

  // Another scene is drawn from now on.
  void change(const Scene& scene, std::int64_t now_ns) {
    scene_ = &scene;
    poses_ = std::make_unique<ObjectPoses>(scene);
    own_ = std::make_unique<OwnBatches>(scene);
    write_bodies(now_ns);
  }

  // Poses and joints as they came; `kind`: of which topic.
  void take(TopicKind kind, std::span<const std::byte> cdr) {
    if (PoseBatch* const batch = own_->decode(kind, cdr)) {
      poses_->take(std::move(*batch), ObjectPoses::Numbers::kOfSender);
    }
  }

  // Written 60 times a second, as fast as a screen shows it. Reports of other scenes are not drawn.
  void take(const clearance_msg_Distances& report, std::int64_t now_ns) {
    constexpr std::int64_t kPeriodNs = 1'000'000'000 / 60;
    if (report.scene_revision != scene_->revision) return;
    poses_->use(report);
    if (now_ns - written_ns_ < kPeriodNs) return;
    written_ns_ = now_ns;
    write(transforms_, now_ns, transforms_message(*scene_, *poses_, now_ns));
    write(closest_, now_ns, closest_message(*scene_, report, now_ns));
  }

 private:
  template <class T>
  void write(std::uint16_t channel, std::int64_t now_ns, const Sample<T>& message) {
    writer_.write(channel, now_ns, encoder_.encode(*message));
  }

  const Scene* scene_;
  RecordingWriter& writer_;
  std::unique_ptr<ObjectPoses> poses_;
  CdrEncoder encoder_;
  std::unique_ptr<OwnBatches> own_;
  std::uint16_t transforms_, closest_, bodies_;
  std::int64_t written_ns_ = 0;
};

}  // namespace clearance
