#include "monitor/intake/ros_transforms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/scene/source_name.hpp"
#include "config/text/spelling.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTf = "/tf", kStatic = "_static";
// The number of reports for one frame. After that, the frame is known to change its parent.
constexpr std::size_t kMostParentsSaid = 3;
constexpr std::size_t kMostListed = 10;

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

TrackedFrames frames_of(const Cell& cell, TransformsFrom from) {
  return TrackedFrames(cell, from == TransformsFrom::kLog ? TrackedFrames::ByName::kYes
                                                          : TrackedFrames::ByName::kNo);
}

}  // namespace

RosTransforms::RosTransforms(const Cell& cell, TransformsFrom from, Outlet& out,
                             UseSensorMessage use)
    : ros_(&cell.ros),
      from_(from),
      out_(out),
      use_(std::move(use)),
      is_used_(use_ && needs_transforms(cell.scene)),
      frames_(frames_of(cell, from)),
      following_(frames_.followers().size(), Following{.state = State::kMissing}) {}

// Transforms stay known. The poses of all followers are handed over anew.
void RosTransforms::change(const Cell& cell) {
  ros_ = &cell.ros;
  is_used_ = use_ && needs_transforms(cell.scene);
  frames_ = frames_of(cell, from_);
  following_.assign(frames_.followers().size(), Following{.state = State::kMissing});
  by_rivals_.clear();
}

// A topic of transforms is /tf or /tf_static; in a log, in any namespace. Both are one source.
std::optional<Decoder::Wanted> RosTransforms::wants(const TopicName& topic) {
  if (!any() || topic.type != kTransformsType) return std::nullopt;
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
  claims_.keep(writers);
  std::erase_if(stamps_, [&](const auto& publisher) {
    return !std::ranges::binary_search(writers, publisher.first);
  });
}

bool RosTransforms::decode(std::uint32_t port, const RawMessage& message, const Now& now,
                           TopicCounts& counts) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  const Topic& topic = topics_[port];
  if (is_used_) {
    using enum RawSensorMessage::Type;
    use_({topic.is_static ? kStaticTransforms : kTransforms,
          {},
          message.sent_ns,
          message.writer,
          {message.cdr.begin(), message.cdr.end()},
          message.bytes});
  }
  placed_twice_ = TfFrames::placed_twice(*message_, topic.is_static);
  for (std::uint32_t i = 0; i < message_->transforms._length; ++i) {
    take(message_->transforms._buffer[i], port, message, now, counts);
  }
  source_ = topic.source;
  if (from_ == TransformsFrom::kLog) hand_over(source_, now);
  return true;
}

void RosTransforms::take(const Transform& transform, std::uint32_t port, const RawMessage& message,
                         const Now& now, TopicCounts& counts) {
  const bool is_static = topics_[port].is_static;
  const std::string child = frame_name(transform.child_frame_id);
  TfTree::Link link{.parent = frame_name(transform.header.frame_id),
                    .parent_from_child = pose_of(transform.transform),
                    .stamp_ns = std::nullopt};
  if (!is_usable(child, link)) return;
  if (!is_static) {
    const OtherClock other =
        from_ == TransformsFrom::kLog ? OtherClock::kReplaced : OtherClock::kTold;
    link.stamp_ns = stamps_[message.writer].time_of(
        stamp_ns(transform.header), message.sent_ns, ros_->stamps, other, counts, out_,
        [&]() -> StampCheck::Whose {
          return {fmt::format("transforms of frame '{}'", child), "'stamps: sent' of 'ros2'"};
        });
  }
  const TfFrames::Publisher publisher{message.writer, port, is_static};
  const auto claims = claims_.claims(child);
  if (!claims.empty() && claims.front().publisher == publisher) note_parent(child, link.parent);
  const bool is_disputed = claims_.set(child, publisher, std::move(link), now.monotonic_ns);
  if (!is_disputed || rivals_said_.size() >= TfFrames::kMostFrames ||
      !rivals_said_.insert(child).second) {
    return;
  }
  out_.tell(News(lines::kFrameOfTwo, child));
}

// A refused transform does not change its frame, which therefore becomes late.
bool RosTransforms::is_usable(const std::string& child, const TfTree::Link& link) {
  const bool is_placed_twice = placed_twice_.contains(child);
  if (is_placed_twice || !TfFrames::is_transform(child, link)) {
    const bool has_names = !child.empty() && !link.parent.empty() && child != link.parent;
    if (refused_said_.size() < TfFrames::kMostFrames && refused_said_.insert(child).second) {
      const char* const why = !has_names        ? "a frame without a name, or its own parent"
                              : is_placed_twice ? "two poses at one time in one message"
                                                : "no pose (not finite, or a quaternion not of "
                                                  "unit length)";
      out_.tell(News(lines::kFrameRefused, child, link.parent, why));
    }
    return false;
  }
  if (!claims_.is_one_too_many(child)) return true;
  if (!std::exchange(too_many_said_, true)) {
    out_.tell(News(lines::kTooManyFrames, child, TfFrames::kMostFrames));
  }
  return false;
}

void RosTransforms::note_parent(const std::string& child, const std::string& parent) {
  const TfTree::Link* const known = claims_.tree().link(child);
  if (known == nullptr || known->parent == parent) return;
  if (++parents_said_[child] > kMostParentsSaid) return;
  const bool is_last = parents_said_[child] == kMostParentsSaid;
  out_.tell(News(lines::kFrameMoved, child, parent, known->parent,
                 is_last ? "; further changes are not named" : ""));
}

void RosTransforms::settle(const Now& now) { hand_over(source_, now); }

// Each base has its own batch, because all positions of a batch have one stamp.
void RosTransforms::hand_over(const std::string& source, const Now& now) {
  claims_.settle(now.monotonic_ns);
  for (auto& [name, batch] : poses_) batch.clear();
  for (std::size_t i = 0; i < following_.size(); ++i) {
    note(i, follow(i, source, now), now);
    follow_rivals(i, source, now);
  }
  for (auto& [name, batch] : poses_) give(batch, name);
}

void RosTransforms::give(PoseBatch& batch, const std::string& source) {
  if (batch.empty()) return;
  batch.source = SourceName(source);
  batch.sequence_number = ++numbers_[source];
  out_.give(batch, kWriter, 0);
}

bool RosTransforms::is_due(const TrackedFrames::Follower& of, const TfTree::Place& place,
                           const HandedOver& last, const Now& now) const {
  return place.stamp_ns ? *place.stamp_ns != last.stamp_ns
                        : now.monotonic_ns - last.at_ns >= of.age_limit_ns / 3;
}

void RosTransforms::add(std::size_t follower, const TfTree::Place& place, const std::string& source,
                        HandedOver& last, const Now& now) {
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  if (!is_due(of, place, last, now)) return;
  last = {.stamp_ns = place.stamp_ns.value_or(now.realtime_ns), .at_ns = now.monotonic_ns};
  if (!of.is_base) {
    frames_.add(follower, place, last.stamp_ns, poses_[source]);
    return;
  }
  base_.clear();
  frames_.add(follower, place, last.stamp_ns, base_);
  give(base_, base_source(source));
}

RosTransforms::State RosTransforms::follow(std::size_t follower, const std::string& source,
                                           const Now& now) {
  const TrackedFrames::Follower& of = frames_.followers()[follower];
  std::string root;
  const auto place = find(of, nullptr, &root);
  if (!place) {
    if (!root.empty()) return State::kElsewhere;
    return claims_.tree().link(of.frame) == nullptr ? State::kMissing : State::kCircle;
  }
  if (!place->is_of_one_time) return State::kApart;
  // A rival without a place gives no pose that could contradict.
  if (!std::ranges::all_of(rivals_of(of, now), &Rival::has_place)) return State::kDisputed;
  if (from_ == TransformsFrom::kLog) roots_.insert(root);
  std::string suffix;
  for (const std::string& frame : claims_.disputed_on(of.frame)) {
    if (suffix.empty()) suffix = claims_.claims(frame).front().suffix;
  }
  add(follower, *place, source + suffix, following_[follower].last, now);
  return State::kFine;
}

// All transforms of a path are those at the stamp of the oldest one.
std::optional<TfTree::Place> RosTransforms::find(const TrackedFrames::Follower& of,
                                                 const TfFrames::Claim* rival, std::string* root,
                                                 const std::string& at) const {
  const auto earlier = [&](const std::string& child, const TfTree::Link& link, std::int64_t ns) {
    const TfFrames::Claim* const claim = rival && child == at ? rival : claims_.used(child);
    return claim == nullptr ? std::nullopt : TfFrames::pose_in(link.parent, *claim, ns);
  };
  if (rival == nullptr) return frames_.find(claims_.tree(), of.frame, root, nullptr, earlier);
  const TfTree::Instead instead{at, rival->link};
  return frames_.find(claims_.tree(), of.frame, root, &instead, earlier);
}

std::vector<RosTransforms::Rival> RosTransforms::rivals_of(const TrackedFrames::Follower& of,
                                                           const Now& now) const {
  std::vector<Rival> rivals;
  for (const std::string& frame : claims_.disputed_on(of.frame)) {
    for (const TfFrames::Claim& claim : claims_.claims(frame).subspan(1)) {
      if (!TfFrames::is_live(claim, now.monotonic_ns)) continue;
      rivals.push_back({frame, claim.suffix, find(of, &claim, nullptr, frame)});
    }
  }
  return rivals;
}

void RosTransforms::follow_rivals(std::size_t follower, const std::string& source, const Now& now) {
  for (const Rival& rival : rivals_of(frames_.followers()[follower], now)) {
    if (!rival.has_place()) continue;
    add(follower, *rival.place, source + rival.suffix,
        by_rivals_[{follower, rival.frame, rival.suffix}], now);
  }
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
    out_.tell(News(lines::kFrameFound, of.frame, of.name));
    return;
  }
  if (following.said || now.monotonic_ns - following.since_ns < kMissingNs) return;
  following.said = following.is_lost = true;
  const bool none = state == State::kMissing && claims_.tree().links().empty();
  out_.tell(News(none ? lines::kNoTransforms : lines::kFrameMissing, of.name, of.frame,
                 what_is_wrong(of, state)));
}

std::string RosTransforms::what_is_wrong(const TrackedFrames::Follower& follower,
                                         State state) const {
  switch (state) {
    case State::kFine:
      return "";
    case State::kMissing: {
      if (claims_.tree().links().empty()) {
        return "but no transform has come on rt/tf or rt/tf_static";
      }
      std::vector<std::string> frames;
      for (const auto& [frame, link] : claims_.tree().links()) frames.push_back(frame);
      return fmt::format("which no transform leads to; there are {}{}", listed(claims_.tree()),
                         did_you_mean(follower.frame, frames));
    }
    case State::kCircle:
      return fmt::format("whose transforms go round in a circle ({})",
                         circle_of(claims_.tree(), follower.frame));
    case State::kApart:
      return "whose path has transforms of times too far apart";
    case State::kDisputed:
      return "which another program sends as well, and by that one it has no place";
    case State::kElsewhere: {
      std::string root;
      static_cast<void>(frames_.find(claims_.tree(), follower.frame, &root));
      return fmt::format("whose transforms lead to '{}' and not to the world_frame '{}'", root,
                         ros_->world_frame);
    }
  }
  return "";
}

std::vector<std::string> RosTransforms::worlds() const {
  std::vector<std::string> worlds;
  for (const std::string& root : roots_) {
    if (!frames_.is_root_link(root) && root != ros_->world()) worlds.push_back(root);
  }
  return worlds;
}

}  // namespace clearance
