#include "tools/view/frame.hpp"

#include <memory>
#include <utility>

#include "monitor/visual/cell_markers.hpp"

namespace clearance::view {
namespace {

Bytes shared(std::vector<std::byte> bytes) {
  return std::make_shared<const std::vector<std::byte>>(std::move(bytes));
}

}  // namespace

void Frame::take(TopicKind kind, std::int64_t time_ns, std::span<const std::byte> cdr) {
  keep(channel(kind), key_of(kind, cdr), time_ns, cdr);
  if (kind == TopicKind::kCatalogue && decoder_.decode(cdr, catalogue_)) {
    revision_ = catalogue_->scene_revision;
  }
}

// What must not replace each other: zones by id, batches by source. Poses are taken along the way.
std::uint32_t Frame::key_of(TopicKind kind, std::span<const std::byte> cdr) {
  if (kind == TopicKind::kZones && decoder_.decode(cdr, zone_)) return zone_->zone;
  if (kind != TopicKind::kPoses || !decoder_.decode(cdr, batch_)) return 0;
  poses_.take(*batch_);
  const auto next = static_cast<std::uint32_t>(sources_.size());
  return sources_.try_emplace(batch_->source, next).first->second;
}

void Frame::keep(ChannelId channel, std::uint32_t key, std::int64_t time_ns,
                 std::span<const std::byte> cdr) {
  new_.insert_or_assign(std::pair{channel, key},
                        Message{channel, key, time_ns, shared({cdr.begin(), cdr.end()})});
}

void Frame::publish(Server& server) {
  if (!std::exchange(bodies_sent_, true)) keep(kBodies, 0, 0, bodies_message(scene_));
  publish_scene(server);
  for (const auto& [place, message] : new_) server.publish(message);
  new_.clear();
}

// Transforms before the report, so that a viewer has moved the bodies when its lines come.
void Frame::publish_scene(Server& server) {
  const auto report = new_.find({channel(TopicKind::kDistances), 0});
  if (report == new_.end() || !decoder_.decode(*report->second.payload, report_)) return;
  const std::int64_t time_ns = report_time_ns_ = report->second.time_ns;
  revision_ = report_->scene_revision;
  poses_.use(*report_);
  server.publish({kTransforms, 0, time_ns, shared(transforms_message(scene_, poses_, time_ns))});
  server.publish({kClosest, 0, time_ns, shared(closest_message(scene_, *report_, time_ns))});
}

}  // namespace clearance::view
