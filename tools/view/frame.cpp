#include "tools/view/frame.hpp"

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "monitor/visual/cell_markers.hpp"
#include "tools/view/json_number.hpp"

namespace clearance::view {
namespace {

Bytes shared(std::span<const std::byte> bytes) {
  return std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
}

nlohmann::json json_of(const Vec3& at) {
  return {{"x", number(at.x())}, {"y", number(at.y())}, {"z", number(at.z())}};
}

}  // namespace

void Frame::take(TopicKind kind, std::int64_t time_ns, std::span<const std::byte> cdr) {
  if (kind == TopicKind::kDistances && is_sparse_) cdr = made_whole(cdr);
  keep(channel(kind), key_of(kind, cdr), time_ns, cdr);
  if (kind == TopicKind::kCatalogue && decoder_.decode(cdr, catalogue_)) {
    revision_ = catalogue_->scene_revision;
  }
}

// The result holds until the next message is encoded.
std::span<const std::byte> Frame::made_whole(std::span<const std::byte> cdr) {
  if (!decoder_.decode(cdr, taken_)) return cdr;
  is_sparse_ = taken_->changes_since != 0;
  if (!is_sparse_) return cdr;
  static_cast<void>(whole_.complete(*taken_));
  return encoder_.encode(*taken_);
}

// A key keeps messages from replacing each other: zones by id, batches by source. Poses and joints
// are taken here as well.
std::uint32_t Frame::key_of(TopicKind kind, std::span<const std::byte> cdr) {
  if (kind == TopicKind::kZones && decoder_.decode(cdr, zone_)) return zone_->zone;
  if (kind != TopicKind::kPoses && kind != TopicKind::kJointStates) return 0;
  PoseBatch* const batch = own_.decode(kind, cdr);
  if (batch == nullptr) return 0;
  const auto next = static_cast<std::uint32_t>(sources_.size());
  const std::uint32_t key = sources_.try_emplace(batch->source.c_str(), next).first->second;
  if (hear_) hear_(*batch);
  poses_.take(std::move(*batch), ObjectPoses::Numbers::kOfSender);
  return key;
}

void Frame::keep(ChannelId channel, std::uint32_t key, std::int64_t time_ns,
                 std::span<const std::byte> cdr) {
  new_.insert_or_assign(std::pair{channel, key}, Message{channel, key, time_ns, shared(cdr)});
}

// Transforms go before the report, so that a viewer has moved the bodies when its lines come.
void Frame::publish(Server& server) {
  use_report();
  publish_if_wanted(server, kBodies, 0, [this] { return bodies_message(scene_); });
  if (report_time_ns_ != 0) {
    publish_if_wanted(server, kTransforms, report_time_ns_,
                      [this] { return transforms_message(scene_, poses_, report_time_ns_); });
    // Ids of a report of another scene mean other objects.
    if (revision_ == scene_.revision) {
      publish_if_wanted(server, kClosest, report_time_ns_,
                        [this] { return closest_message(scene_, *report_, report_time_ns_); });
    }
  }
  for (const auto& [place, message] : new_) server.publish(message);
  new_.clear();
}

std::string Frame::distance_json(std::uint32_t a, std::uint32_t b) {
  if (!measured_) measured_.emplace(scene_);
  const bool is_current = report_time_ns_ != 0 && revision_ == scene_.revision;
  const auto found = is_current ? measured_->between(a, b, poses_) : MeasuredDistance();
  const auto age = [&](std::uint32_t object) {
    return object < scene_.objects.size() ? poses_.age_ns(object) : -1;
  };
  return nlohmann::json{{"status", found.status},
                        {"distance", number(found.distance)},
                        {"lower", number(found.lower)},
                        {"upper", number(found.upper)},
                        {"witness_a", json_of(found.witness_a)},
                        {"witness_b", json_of(found.witness_b)},
                        {"age_a_ns", age(a)},
                        {"age_b_ns", age(b)}}
      .dump();
}

void Frame::use_report() {
  const auto report = new_.find({channel(TopicKind::kDistances), 0});
  if (report == new_.end() || !decoder_.decode(*report->second.payload, report_)) return;
  is_sparse_ = is_sparse_ || report_->changes_since != 0;
  report_time_ns_ = report->second.time_ns;
  revision_ = report_->scene_revision;
  poses_.use(*report_);
  sent_.reset(kTransforms);
  sent_.reset(kClosest);
}

template <class Make>
void Frame::publish_if_wanted(Server& server, ChannelId channel, std::int64_t time_ns,
                              const Make& make) {
  if (sent_.test(channel) || !server.is_wanted(channel)) return;
  sent_.set(channel);
  server.publish({channel, 0, time_ns, shared(encoder_.encode(*make()))});
}

}  // namespace clearance::view
