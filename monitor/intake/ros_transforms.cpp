#include "monitor/intake/ros_transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/text/spelling.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTransformsType = "tf2_msgs/msg/TFMessage";
constexpr std::string_view kTf = "/tf", kStatic = "_static";
// The number of reports for one frame. After that, the frame is known to change its parent.
constexpr std::size_t kMostParentsSaid = 3;
constexpr std::size_t kMostListed = 10;

bool same_pose(const Pose& a, const Pose& b) noexcept {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

// The existing frames, in a list that a person can read.
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

// The path from a frame until it closes a cycle.
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

RosTransforms::RosTransforms(const Cell& cell, TransformsFrom from, Outlet& out)
    : ros_(cell.ros),
      from_(from),
      out_(out),
      frames_(cell, from == TransformsFrom::kLog ? TrackedFrames::ByName::kYes
                                                 : TrackedFrames::ByName::kNo),
      following_(frames_.followers().size(), Following{.state = State::kMissing}) {}

// A topic of transforms is /tf or /tf_static; in a log, in any namespace. Both are one source.
std::optional<Decoder::Wanted> RosTransforms::wants(const TopicName& topic) {
  if (!frames_.any() || topic.type != kTransformsType) return std::nullopt;
  const bool is_static = topic.name.ends_with(kStatic);
  const std::string source =
      topic.name.substr(0, topic.name.size() - (is_static ? kStatic.size() : 0));
  const bool is_tf = from_ == TransformsFrom::kLog ? ("/" + source).ends_with(kTf) : source == kTf;
  if (!is_tf) return std::nullopt;
  const auto known = std::ranges::find(topics_, topic.name, &Topic::name);
  const auto port = static_cast<std::uint32_t>(known - topics_.begin());
  if (known == topics_.end()) topics_.push_back({topic.name, source, is_static});
  return Wanted{port, is_static ? &kRosTfStatic : &kRosTf};
}

// A third of the age limit: a static pose is handed over twice before it is late.
std::int64_t RosTransforms::patience_ns() const {
  if (!frames_.any()) return Decoder::patience_ns();
  std::int64_t patience = kMissingNs / 10;
  for (const TrackedFrames::Follower& follower : frames_.followers())
    patience = std::min(patience, follower.age_limit_ns / 3);
  return patience;
}

void RosTransforms::keep(std::span<const std::uint64_t> writers) {
  writers_.assign(writers.begin(), writers.end());
  const auto is_gone = [&](std::uint64_t writer) {
    return !std::ranges::binary_search(writers_, writer);
  };
  std::erase_if(owners_, [&](const auto& owner) { return is_gone(owner.second.writer); });
  std::erase_if(stamps_, [&](const auto& publisher) { return is_gone(publisher.first); });
}

bool RosTransforms::decode(std::uint32_t port, const RawMessage& message, const Now& now,
                           TopicCounts& counts) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  const Topic& topic = topics_[port];
  for (std::uint32_t i = 0; i < message_->transforms._length; ++i) {
    take(message_->transforms._buffer[i], topic, message, now, counts);
  }
  if (from_ == TransformsFrom::kLog) hand_over(topic.source, now);
  return true;
}

void RosTransforms::take(const Transform& transform, const Topic& topic, const RawMessage& message,
                         const Now& now, TopicCounts& counts) {
  const std::string child = frame_name(transform.child_frame_id);
  TfTree::Link link{.parent = frame_name(transform.header.frame_id),
                    .parent_from_child = pose_of(transform.transform),
                    .stamp_ns = std::nullopt};
  if (!is_usable(child, link) || !admits(child, link, message.writer, topic.is_static, now)) return;
  if (!topic.is_static) {
    const OtherClock other =
        from_ == TransformsFrom::kLog ? OtherClock::kReplaced : OtherClock::kTold;
    link.stamp_ns = stamps_[message.writer].time_of(
        stamp_ns(transform.header), message.sent_ns, ros_.stamps, other, counts, out_,
        [&]() -> StampCheck::Whose {
          return {fmt::format("transforms of frame '{}'", child), "'stamps: sent' of 'ros2'"};
        });
  }
  note_parent(child, link.parent);
  tree_.set(child, std::move(link));
}

// A refused transform does not change its frame, which therefore becomes late.
bool RosTransforms::is_usable(const std::string& child, const TfTree::Link& link) {
  const Eigen::Quaterniond& turn = link.parent_from_child.orientation;
  const bool is_pose = link.parent_from_child.position.allFinite() &&
                       std::abs(turn.norm() - 1.0) <= kSampleUnitTolerance;
  const bool has_names = !child.empty() && !link.parent.empty() && child != link.parent;
  if (!is_pose || !has_names) {
    if (refused_said_.size() < kMostFrames && refused_said_.insert(child).second) {
      const char* const why = has_names ? "no pose (not finite, or a quaternion not of unit length)"
                                        : "a frame without a name, or its own parent";
      out_.tell({.cause = News::Cause::kFrameRefused,
                 .text = fmt::format("transforms of frame '{}' to '{}' are not used: {}", child,
                                     link.parent, why)});
    }
    return false;
  }
  if (tree_.links().size() < kMostFrames || tree_.link(child) != nullptr) return true;
  if (!std::exchange(too_many_said_, true)) {
    out_.tell({.cause = News::Cause::kTooManyFrames,
               .text = fmt::format("frame '{}' is one too many: {} frames are heard", child,
                                   kMostFrames)});
  }
  return false;
}

bool RosTransforms::admits(const std::string& child, const TfTree::Link& link, std::uint64_t writer,
                           bool is_static, const Now& now) {
  const auto [found, is_new] = owners_.try_emplace(child);
  Owner& owner = found->second;
  // Samples of a publisher may arrive after the notice that it has left.
  const bool is_held = !is_new && owner.writer != writer &&
                       std::ranges::binary_search(writers_, owner.writer) &&
                       (owner.is_static || now.monotonic_ns - owner.last_ns < kFrameHeldNs);
  if (!is_held) {
    owner.writer = writer;
    owner.is_static = is_static;
    owner.last_ns = now.monotonic_ns;
    return true;
  }
  const TfTree::Link* const known = tree_.link(child);
  const bool says_the_same = known != nullptr && known->parent == link.parent &&
                             same_pose(known->parent_from_child, link.parent_from_child);
  if (!says_the_same && !std::exchange(owner.rival_said, true)) {
    const char* const where = owner.is_static != is_static ? ", on tf and on tf_static" : "";
    out_.tell({.cause = News::Cause::kFrameOfTwo,
               .text = fmt::format("frame '{}' is sent by two publishers{}: transforms of the one "
                                   "that came later are not used",
                                   child, where)});
  }
  return false;
}

void RosTransforms::note_parent(const std::string& child, const std::string& parent) {
  const TfTree::Link* const known = tree_.link(child);
  if (known == nullptr || known->parent == parent) return;
  if (++parents_said_[child] > kMostParentsSaid) return;
  const bool is_last = parents_said_[child] == kMostParentsSaid;
  out_.tell({.cause = News::Cause::kFrameMoved,
             .is_warning = false,
             .text = fmt::format("frame '{}' hangs on '{}' now, before on '{}'{}", child, parent,
                                 known->parent, is_last ? "; further changes are not named" : "")});
}

void RosTransforms::settle(const Now& now) {
  if (from_ == TransformsFrom::kPublishers) hand_over(std::string(kTf), now);
}

// Each base has its own batch, because all positions of a batch have one stamp.
void RosTransforms::hand_over(const std::string& source, const Now& now) {
  poses_.clear();
  for (std::size_t i = 0; i < following_.size(); ++i) {
    base_.clear();
    note(i, follow(i, now), now);
    give(base_, base_source(source));
  }
  give(poses_, source);
}

void RosTransforms::give(PoseBatch& batch, const std::string& source) {
  if (batch.empty()) return;
  batch.source = SourceName(source);
  batch.sequence_number = ++numbers_[source];
  out_.give(batch, kWriter, 0);
}

bool RosTransforms::is_due(const TrackedFrames::Follower& of, const TfTree::Place& place,
                           const Following& following, const Now& now) const {
  if (from_ == TransformsFrom::kLog) return true;
  return place.stamp_ns ? *place.stamp_ns != following.stamp_ns
                        : now.monotonic_ns - following.handed_over_ns >= of.age_limit_ns / 3;
}

RosTransforms::State RosTransforms::follow(std::size_t follower, const Now& now) {
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  Following& following = following_[follower];
  std::string root;
  const auto place = frames_.find(tree_, of.frame, &root);
  if (!place) {
    if (!root.empty()) return State::kElsewhere;
    return tree_.link(of.frame) == nullptr ? State::kMissing : State::kCircle;
  }
  if (from_ == TransformsFrom::kLog) roots_.insert(root);
  if (!is_due(of, *place, following, now)) return State::kFine;
  const std::int64_t stamp = place->stamp_ns.value_or(now.realtime_ns);
  frames_.add(follower, place->root_from_frame, stamp, of.is_base ? base_ : poses_);
  following.stamp_ns = stamp;
  following.handed_over_ns = now.monotonic_ns;
  return State::kFine;
}

void RosTransforms::note(std::size_t follower, State state, const Now& now) {
  Following& following = following_[follower];
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  if (state != following.state || following.since_ns < 0) {
    following.state = state;
    following.since_ns = now.monotonic_ns;
    following.said = false;
  }
  if (state == State::kFine) {
    if (!std::exchange(following.is_lost, false)) return;
    out_.tell({.cause = News::Cause::kFrameFound,
               .is_warning = false,
               .text = fmt::format("frame '{}', which {} follows, is there", of.frame, of.name)});
    return;
  }
  if (following.said || now.monotonic_ns - following.since_ns < kMissingNs) return;
  following.said = following.is_lost = true;
  const bool none = state == State::kMissing && tree_.links().empty();
  out_.tell({.cause = none ? News::Cause::kNoTransforms : News::Cause::kFrameMissing,
             .text = fmt::format("{} is not known: it follows the frame '{}', {}", of.name,
                                 of.frame, what_is_wrong(of, state))});
}

std::string RosTransforms::what_is_wrong(const TrackedFrames::Follower& follower,
                                         State state) const {
  switch (state) {
    case State::kFine:
      return "";
    case State::kMissing: {
      if (tree_.links().empty()) {
        return "but no transform has come on rt/tf or rt/tf_static";
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

std::vector<std::string> RosTransforms::worlds() const {
  std::vector<std::string> worlds;
  for (const std::string& root : roots_) {
    if (!frames_.is_root_link(root) && root != ros_.world()) worlds.push_back(root);
  }
  return worlds;
}

}  // namespace clearance
