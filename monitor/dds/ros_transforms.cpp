#include "monitor/dds/ros_transforms.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/text/spelling.hpp"
#include "monitor/loop/ports.hpp"

namespace clearance {
namespace {

constexpr const char* kTf = "rt/tf";
constexpr const char* kTfStatic = "rt/tf_static";
constexpr const char* kSource = "/tf";
// Of one frame: after that it is known to change its parent.
constexpr std::size_t kMostParentsSaid = 3;
constexpr std::size_t kMostListed = 10;

bool same_pose(const Pose& a, const Pose& b) noexcept {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

// The frames that there are, as far as a person reads them.
std::string listed(const TfTree& tree) {
  std::string text;
  std::size_t count = 0;
  for (const auto& [frame, link] : tree.links()) {
    if (count++ == kMostListed)
      return fmt::format("{} and {} more", text, tree.links().size() - kMostListed);
    text += (text.empty() ? "" : ", ") + frame;
  }
  return text;
}

// The way from a frame until it comes round.
std::string circle_of(const TfTree& tree, const std::string& frame) {
  std::string text = frame;
  std::set<std::string> met = {frame};
  for (const TfTree::Link* link = tree.link(frame); link != nullptr;
       link = tree.link(link->parent)) {
    text += ", " + link->parent;
    if (!met.insert(link->parent).second) break;
  }
  return text;
}

}  // namespace

RosTransforms::RosTransforms(const Cell& cell, Participant& participant,
                             const PresentTopics& present)
    : scene_(cell.scene),
      ros_(cell.ros),
      present_(present),
      where_(participant.where()),
      frames_(cell) {
  poses_.source = SourceName(kSource);
  bases_.source = SourceName(base_source(kSource));
  following_.resize(frames_.followers().size(),
                    Following{.state = State::kMissing, .since_ns = SystemClock().monotonic_ns()});
  if (!any()) return;
  reader_ = participant.ros_reader(kRosTf, kTf);
  static_reader_ = participant.ros_reader(kRosTfStatic, kTfStatic);
}

RosTransforms::~RosTransforms() {
  for (const dds_entity_t reader : readers()) dds_delete(reader);
}

std::vector<dds_entity_t> RosTransforms::readers() const {
  if (!any()) return {};
  return {reader_, static_reader_};
}

// A third of the age limit: what never changes is handed over twice before it is late.
std::int64_t RosTransforms::patience_ns() const noexcept {
  if (!any()) return DDS_INFINITY;
  std::int64_t patience = kMissingNs / 10;
  for (const TrackedFrames::Follower& follower : frames_.followers())
    patience = std::min(patience, follower.age_limit_ns / 3);
  return patience;
}

void RosTransforms::look() {
  const auto is_gone = [&](std::uint64_t writer) { return !present_.writers().contains(writer); };
  std::erase_if(owners_, [&](const auto& owner) { return is_gone(owner.second.writer); });
  std::erase_if(stamps_, [&](const auto& publisher) { return is_gone(publisher.first); });
}

void RosTransforms::take_all(const std::function<void(const PoseBatch&)>& hand_over) {
  now_ns_ = SystemClock().monotonic_ns();
  take(static_reader_, true);
  take(reader_, false);
  const auto give = [&](PoseBatch& batch) {
    if (batch.empty()) return;
    ++batch.sequence_number;
    hand_over(batch);
  };
  poses_.samples.clear();
  for (std::size_t i = 0; i < following_.size(); ++i) {
    bases_.joints.clear();
    note(i, follow(i));
    give(bases_);
  }
  give(poses_);
}

void RosTransforms::take(dds_entity_t reader, bool is_static) {
  Sample<tf2_msgs_msg_dds__TFMessage_> message;
  void* pointer = &*message;
  dds_sample_info_t info;
  while (dds_take(reader, &pointer, &info, 1, 1) > 0) {
    if (!info.valid_data) continue;
    for (std::uint32_t i = 0; i < message->transforms._length; ++i) {
      take(message->transforms._buffer[i], sent_ns(info.source_timestamp), info.publication_handle,
           is_static);
    }
  }
}

void RosTransforms::take(const Transform& transform, std::int64_t sent_ns, std::uint64_t writer,
                         bool is_static) {
  const std::string child = frame_name(transform.child_frame_id);
  TfTree::Link link{.parent = frame_name(transform.header.frame_id),
                    .parent_from_child = pose_of(transform.transform),
                    .stamp_ns = std::nullopt};
  if (!is_usable(child, link) || !admits(child, link, writer, is_static)) return;
  if (!is_static) {
    link.stamp_ns = stamps_[writer].time_of(
        stamp_ns(transform.header), sent_ns, ros_.stamps, [&]() -> RosStampCheck::Whose {
          return {fmt::format("transforms of frame '{}'", child), "'stamps: sent' of 'ros2'"};
        });
  }
  note_parent(child, link.parent);
  tree_.set(child, std::move(link));
}

// What is refused leaves the frame as it is, and so late.
bool RosTransforms::is_usable(const std::string& child, const TfTree::Link& link) {
  const Eigen::Quaterniond& turn = link.parent_from_child.orientation;
  const bool is_pose = link.parent_from_child.position.allFinite() &&
                       std::abs(turn.norm() - 1.0) <= kSampleUnitTolerance;
  const bool has_names = !child.empty() && !link.parent.empty() && child != link.parent;
  if (!is_pose || !has_names) {
    if (refused_said_.size() < kMostFrames && refused_said_.insert(child).second) {
      spdlog::warn("transforms of frame '{}' to '{}' are not used: {}", child, link.parent,
                   has_names ? "no pose (not finite, or a quaternion not of unit length)"
                             : "a frame without a name, or its own parent");
    }
    return false;
  }
  if (tree_.links().size() < kMostFrames || tree_.link(child) != nullptr) return true;
  if (!std::exchange(too_many_said_, true))
    spdlog::warn("frame '{}' is one too many: {} frames are heard", child, kMostFrames);
  return false;
}

bool RosTransforms::admits(const std::string& child, const TfTree::Link& link, std::uint64_t writer,
                           bool is_static) {
  const auto [found, is_new] = owners_.try_emplace(child);
  Owner& owner = found->second;
  // Samples of a publisher that has left may come after the news of it.
  const bool is_held = !is_new && owner.writer != writer &&
                       present_.writers().contains(owner.writer) &&
                       (owner.is_static || now_ns_ - owner.last_ns < kFrameHeldNs);
  if (!is_held) {
    owner.writer = writer;
    owner.is_static = is_static;
    owner.last_ns = now_ns_;
    return true;
  }
  const TfTree::Link* const known = tree_.link(child);
  const bool says_the_same = known != nullptr && known->parent == link.parent &&
                             same_pose(known->parent_from_child, link.parent_from_child);
  if (!says_the_same && !std::exchange(owner.rival_said, true)) {
    spdlog::warn(
        "frame '{}' is sent by two publishers{}: transforms of the one that came later are not "
        "used",
        child, owner.is_static != is_static ? ", on tf and on tf_static" : "");
  }
  return false;
}

void RosTransforms::note_parent(const std::string& child, const std::string& parent) {
  const TfTree::Link* const known = tree_.link(child);
  if (known == nullptr || known->parent == parent) return;
  if (++parents_said_[child] > kMostParentsSaid) return;
  spdlog::info("frame '{}' hangs on '{}' now, before on '{}'{}", child, parent, known->parent,
               parents_said_[child] == kMostParentsSaid ? "; further changes are not named" : "");
}

RosTransforms::State RosTransforms::follow(std::size_t follower) {
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  Following& following = following_[follower];
  std::string root;
  const auto place = frames_.find(tree_, of.frame, &root);
  if (!place) {
    if (!root.empty()) return State::kElsewhere;
    return tree_.link(of.frame) == nullptr ? State::kMissing : State::kCircle;
  }
  const bool is_due = place->stamp_ns ? *place->stamp_ns != following.stamp_ns
                                      : now_ns_ - following.handed_over_ns >= of.age_limit_ns / 3;
  if (!is_due) return State::kFine;
  const std::int64_t stamp = place->stamp_ns.value_or(dds_time());
  frames_.add(follower, place->root_from_frame, stamp, of.is_base ? bases_ : poses_);
  following.stamp_ns = stamp;
  following.handed_over_ns = now_ns_;
  return State::kFine;
}

void RosTransforms::note(std::size_t follower, State state) {
  Following& following = following_[follower];
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  if (state != following.state) {
    following.state = state;
    following.since_ns = now_ns_;
    following.said = false;
  }
  if (state == State::kFine) {
    if (std::exchange(following.is_lost, false))
      spdlog::info("frame '{}', which {} follows, is there", of.frame, of.name);
    return;
  }
  if (following.said || now_ns_ - following.since_ns < kMissingNs) return;
  following.said = following.is_lost = true;
  spdlog::warn("{} is not known: it follows the frame '{}', {}", of.name, of.frame,
               what_is_wrong(of, state));
}

std::string RosTransforms::what_is_wrong(const TrackedFrames::Follower& follower,
                                         State state) const {
  switch (state) {
    case State::kFine:
      return "";
    case State::kMissing: {
      if (tree_.links().empty()) {
        return fmt::format("but no transform has come on {} or {} on {}; there is: {}", kTf,
                           kTfStatic, where_, present_.listed());
      }
      std::vector<std::string> frames;
      for (const auto& [frame, link] : tree_.links()) frames.push_back(frame);
      return fmt::format("which no transform leads to; there are {}{}", listed(tree_),
                         did_you_mean(follower.frame, frames));
    }
    case State::kCircle:
      return fmt::format("whose transforms go round in a circle ({})",
                         circle_of(tree_, follower.frame));
    case State::kElsewhere: {
      std::string root;
      static_cast<void>(frames_.find(tree_, follower.frame, &root));
      return fmt::format("whose transforms lead to '{}' and not to the world_frame '{}'", root,
                         ros_.world_frame);
    }
  }
  return "";
}

}  // namespace clearance
