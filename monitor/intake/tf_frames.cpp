#include "monitor/intake/tf_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/mean_twist.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {
namespace {

constexpr const char* kStaticSuffix = "_static";

bool says_the_same(const TfTree::Link& a, const TfTree::Link& b) noexcept {
  return a.parent == b.parent && same_pose(a.parent_from_child, b.parent_from_child);
}

// Stamps that are closer than this give no velocity.
constexpr std::int64_t kLeastIntervalNs = 1'000'000;

// Sets the velocity of a transform from the one before it.
void set_twist(const TfTree::Link& before, TfTree::Link& link) {
  if (!link.stamp_ns || !before.stamp_ns || before.parent != link.parent) return;
  const std::int64_t interval_ns = elapsed(*before.stamp_ns, *link.stamp_ns);
  if (interval_ns < kLeastIntervalNs) {
    link.twist = before.twist;
    link.interval_ns = before.interval_ns;
    return;
  }
  link.twist = mean_twist(before.parent_from_child, link.parent_from_child, seconds(interval_ns));
  link.interval_ns = interval_ns;
}

}  // namespace

bool TfFrames::is_transform(const std::string& child, const TfTree::Link& link) noexcept {
  const Eigen::Quaterniond& turn = link.parent_from_child.orientation;
  return link.parent_from_child.position.allFinite() &&
         std::abs(turn.norm() - 1.0) <= kSampleUnitTolerance && !child.empty() &&
         !link.parent.empty() && child != link.parent;
}

std::set<std::string> TfFrames::placed_twice(const tf2_msgs_msg_dds__TFMessage_& message,
                                             bool is_static) {
  std::map<std::pair<std::string, std::int64_t>, TfTree::Link> links;
  std::set<std::string> twice;
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const auto& each = message.transforms._buffer[i];
    const TfTree::Link link{.parent = frame_name(each.header.frame_id),
                            .parent_from_child = pose_of(each.transform),
                            .stamp_ns = std::nullopt};
    const std::string child = frame_name(each.child_frame_id);
    const auto [first, is_new] =
        links.try_emplace({child, is_static ? 0 : stamp_ns(each.header)}, link);
    if (!is_new && !says_the_same(first->second, link)) twice.insert(child);
  }
  return twice;
}

std::span<const TfFrames::Claim> TfFrames::claims(const std::string& child) const {
  const auto found = frames_.find(child);
  return found == frames_.end() ? std::span<const Claim>() : std::span(found->second.claims);
}

const TfFrames::Claim* TfFrames::used(const std::string& child) const {
  const auto found = frames_.find(child);
  if (found == frames_.end()) return nullptr;
  const auto& [claims, left] = found->second;
  return !claims.empty() ? &claims.front() : left ? &*left : nullptr;
}

// Adds a claim with a suffix that no other claim of the frame has. The first claim on tf gets an
// empty one, so earlier claims on tf_static get new suffixes. A new publisher goes on where the
// last one has left.
TfFrames::Claim& TfFrames::add(const Publisher& publisher, Frame& frame) {
  std::vector<Claim>& claims = frame.claims;
  const auto is_moving = [](const Claim& claim) { return !claim.publisher.is_static; };
  const bool has_rivals_on_tf = std::ranges::any_of(claims, is_moving);
  if (!publisher.is_static && !has_rivals_on_tf) {
    for (std::size_t i = 0; i < claims.size(); ++i)
      claims[i].suffix = i == 0 ? kStaticSuffix : fmt::format("{}#{}", kStaticSuffix, i + 1);
  }
  const std::string stem = publisher.is_static && has_rivals_on_tf ? kStaticSuffix : "";
  std::string suffix = stem;
  const auto is_taken = [&](const Claim& claim) { return claim.suffix == suffix; };
  for (int number = 2; std::ranges::any_of(claims, is_taken); ++number)
    suffix = fmt::format("{}#{}", stem, number);
  Claim& added = claims.emplace_back();
  added.publisher = publisher;
  added.suffix = suffix;
  const std::optional<Claim> left = std::exchange(frame.left, std::nullopt);
  if (left && left->publisher.is_static == publisher.is_static) {
    added.last = left->last;
    added.before = left->before;
  }
  return added;
}

// Sorts the claim that is used to the front: tf before tf_static, then live before silent, then by
// number. A silent publisher on tf is not replaced by tf_static, which never ages.
void TfFrames::choose(std::vector<Claim>& claims, std::int64_t monotonic_ns) {
  const auto rank = [&](const Claim& claim) {
    return std::tuple(claim.publisher.is_static, !is_live(claim, monotonic_ns), claim.suffix);
  };
  std::ranges::sort(claims, {}, rank);
}

bool TfFrames::set(const std::string& child, const Publisher& publisher, TfTree::Link link,
                   std::int64_t monotonic_ns) {
  Frame& frame = frames_[child];
  std::vector<Claim>& claims = frame.claims;
  auto claim = std::ranges::find(claims, publisher, &Claim::publisher);
  if (claim == claims.end()) {
    if (claims.size() >= kMostClaims) return true;
    add(publisher, frame);
    claim = claims.end() - 1;
    if (claims.size() == 2) disputed_.insert(child);
  }
  set_twist(claim->link, link);
  claim->link = std::move(link);
  claim->heard_ns = monotonic_ns;
  note(*claim);
  if (claims.size() > 1) choose(claims, monotonic_ns);
  tree_.set(child, claims.front().link);
  const auto differs = [&](const Claim& other) {
    return is_live(other, monotonic_ns) && !says_the_same(other.link, claims.front().link);
  };
  return std::any_of(claims.begin() + 1, claims.end(), differs);
}

// A frame without a publisher keeps its last transform, which ages.
void TfFrames::keep(std::span<const std::uint64_t> writers) {
  const auto has_left = [&](const Claim& claim) {
    return !std::ranges::binary_search(writers, claim.publisher.writer);
  };
  for (auto& [child, frame] : frames_) {
    if (!frame.claims.empty() && std::ranges::all_of(frame.claims, has_left))
      frame.left = std::move(frame.claims.front());
    const std::size_t gone = std::erase_if(frame.claims, has_left);
    if (gone > 0 && !frame.claims.empty()) tree_.set(child, frame.claims.front().link);
  }
  std::erase_if(disputed_, [&](const std::string& child) {
    const std::vector<Claim>& claims = frames_[child].claims;
    return claims.empty() || (claims.size() == 1 && claims.front().suffix.empty());
  });
}

// The frames may form a cycle, so the number of steps is limited.
std::vector<std::string> TfFrames::disputed_on(const std::string& frame) const {
  std::vector<std::string> disputed;
  if (disputed_.empty()) return disputed;
  std::size_t steps = 0;
  for (const std::string* child = &frame; steps <= tree_.links().size(); ++steps) {
    if (disputed_.contains(*child)) disputed.push_back(*child);
    const TfTree::Link* const link = tree_.link(*child);
    if (link == nullptr) break;
    child = &link->parent;
  }
  return disputed;
}

void TfFrames::settle(std::int64_t monotonic_ns) {
  for (const std::string& child : disputed_) {
    std::vector<Claim>& claims = frames_[child].claims;
    choose(claims, monotonic_ns);
    tree_.set(child, claims.front().link);
  }
}

void TfFrames::note(Claim& claim) const {
  const TfTree::Link& link = claim.link;
  const bool is_static = !link.stamp_ns;
  if (claim.last.parent != link.parent) {
    std::swap(claim.last, claim.before);
    claim.last.parent = link.parent;
    claim.last.poses = PoseSeries(is_static ? 1 : kept_);
  }
  if (is_static) claim.last.poses.clear();
  const auto& [position, orientation] = link.parent_from_child;
  claim.last.poses.add(link.stamp_ns.value_or(1), {position, orientation.normalized()});
}

void TfFrames::forget() {
  for (auto& [child, frame] : frames_) {
    if (frame.left && !frame.left->publisher.is_static) frame.left.reset();
    for (Claim& claim : frame.claims) {
      if (!claim.publisher.is_static) claim.last = claim.before = {};
    }
  }
}

const TfFrames::Stretch* TfFrames::stretch(const Claim& claim, std::int64_t stamp_ns) noexcept {
  const auto& [last, before] = std::tie(claim.last, claim.before);
  if (last.poses.empty()) return nullptr;
  const bool is_of_last =
      claim.publisher.is_static || before.poses.empty() || stamp_ns >= last.poses.at(0).stamp_ns;
  if (is_of_last) return &last;
  return stamp_ns <= before.poses.last().stamp_ns ? &before : nullptr;
}

std::optional<TfFrames::Parent> TfFrames::parent(const Claim& claim, std::int64_t stamp_ns) {
  const Stretch* const found = stretch(claim, stamp_ns);
  if (found == nullptr) return std::nullopt;
  return Parent{&found->parent, claim.publisher.is_static ? std::numeric_limits<std::int64_t>::max()
                                                          : found->poses.last().stamp_ns};
}

std::optional<TfFrames::Step> TfFrames::step(const Claim& claim, std::int64_t stamp_ns,
                                             std::int64_t within_ns) {
  const Stretch* const found = stretch(claim, stamp_ns);
  if (found == nullptr) return std::nullopt;
  const PoseSeries& poses = found->poses;
  Step step{.parent_from_child = poses.last().value};
  if (claim.publisher.is_static) return step;
  const std::int64_t first_ns = stamp_ns - within_ns, last_ns = stamp_ns + within_ns;
  if (first_ns < poses.at(0).stamp_ns || last_ns > poses.last().stamp_ns) return std::nullopt;
  step.parent_from_child = pose_at(poses, stamp_ns);
  const PoseSpread error = spread(poses, step.parent_from_child, first_ns, last_ns);
  if (error.longest_ns > kSourceSilentNs) return std::nullopt;
  step.shift_error = error.shift;
  step.turn_error = error.turn;
  step.longest_ns = error.longest_ns;
  return step;
}

std::optional<Pose> TfFrames::pose_in(const std::string& parent, const Claim& claim,
                                      std::int64_t stamp_ns) {
  const auto then = TfFrames::parent(claim, stamp_ns);
  const auto found = then && *then->name == parent ? step(claim, stamp_ns) : std::nullopt;
  return found ? std::optional(found->parent_from_child) : std::nullopt;
}

void TfFrames::append_stamps(const Claim& claim, std::int64_t first_ns, std::int64_t last_ns,
                             std::vector<std::int64_t>& stamps) {
  if (claim.publisher.is_static) return;
  for (const Stretch* const part : {&claim.before, &claim.last}) {
    const PoseSeries& poses = part->poses;
    std::size_t i = poses.first_from(first_ns);
    for (i = i > 0 ? i - 1 : i; i < poses.size(); ++i) {
      stamps.push_back(poses.at(i).stamp_ns);
      if (stamps.back() >= last_ns) break;
    }
  }
}

}  // namespace clearance
