// The newest message of every topic for the viewers. Some pass unchanged. Transforms and markers
// are made from poses, joints and report while a viewer subscribes to them.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "monitor/client/complete_reports.hpp"
#include "monitor/intake/own_batches.hpp"
#include "monitor/visual/measured_distance.hpp"
#include "monitor/visual/object_poses.hpp"
#include "monitor/wire/cdr.hpp"
#include "tools/view/server.hpp"

namespace clearance::view {

class Frame {
 public:
  // `hear` gets each batch of poses and joints that is taken; it may be empty.
  using Hear = std::function<void(const PoseBatch& batch)>;
  explicit Frame(const Scene& scene, Hear hear = {})
      : scene_(scene), hear_(std::move(hear)), poses_(scene), own_(scene) {}

  // Takes one message of our topics. It keeps the bytes of a report and the numbers of poses
  // and joints, which is cheap for every message of a fast stream. Reports that carry only the
  // pairs that changed are made whole, so each of them has to come.
  void take(TopicKind kind, std::int64_t time_ns, std::span<const std::byte> cdr);
  // The last report that was used has only the pairs that changed, or none has come.
  [[nodiscard]] bool lacks_pairs() const noexcept { return is_sparse_; }
  // Poses or joints of a topic of ROS 2.
  void take_from_ros(PoseBatch batch) {
    if (hear_) hear_(batch);
    poses_.take(std::move(batch), ObjectPoses::Numbers::kUnnumbered);
  }

  // The latest catalogue; its revision is 0 before the first one.
  [[nodiscard]] const clearance_msg_Catalogue& catalogue() const noexcept { return *catalogue_; }

  [[nodiscard]] const ObjectPoses& poses() const noexcept { return poses_; }

  // Sends the messages that came since the last call.
  void publish(Server& server);
  // Places the objects where the newest report that was taken has them. publish() does so, too.
  void use_report();

  // The revision of the latest report or catalogue; 0 until one has come.
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  [[nodiscard]] std::int64_t report_time_ns() const noexcept { return report_time_ns_; }
  // The distance of two objects of the scene at the poses of the latest report, as JSON with the
  // members of a report's pair, the ages included. null: infinite or not known.
  [[nodiscard]] std::string distance_json(std::uint32_t a, std::uint32_t b);
  // The recording moves to another time: earlier poses no longer hold.
  void jump() { poses_.forget(); }

 private:
  void keep(ChannelId channel, std::uint32_t key, std::int64_t time_ns,
            std::span<const std::byte> cdr);
  std::uint32_t key_of(TopicKind kind, std::span<const std::byte> cdr);
  [[nodiscard]] std::span<const std::byte> made_whole(std::span<const std::byte> cdr);
  // Publishes once per report; bodies only once.
  template <class Make>
  void publish_if_wanted(Server& server, ChannelId channel, std::int64_t time_ns, const Make& make);

  const Scene& scene_;
  Hear hear_;
  ObjectPoses poses_;
  std::optional<MeasuredDistances> measured_;  // made when it is first asked for
  OwnBatches own_;
  CdrDecoder decoder_;
  CdrEncoder encoder_;
  Sample<clearance_msg_Distances> report_, taken_;
  client::CompleteReports whole_;
  bool is_sparse_ = true;  // reports carry only what changed, or none has come
  Sample<clearance_msg_ZoneState> zone_;
  Sample<clearance_msg_Catalogue> catalogue_;
  std::map<std::string, std::uint32_t> sources_;  // numbered in the order in which they came
  std::map<std::pair<ChannelId, std::uint32_t>, Message> new_;
  std::uint64_t revision_ = 0;
  std::int64_t report_time_ns_ = 0;
  std::bitset<kChannels> sent_;  // channels of the scene that need not be made again
};

}  // namespace clearance::view
