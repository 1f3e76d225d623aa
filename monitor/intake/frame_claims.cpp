#include "monitor/intake/frame_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/mean_twist.hpp"

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

std::span<const FrameClaims::Claim> FrameClaims::claims(const std::string& child) const {
  const auto found = claims_.find(child);
  return found == claims_.end() ? std::span<const Claim>() : std::span(found->second);
}

// Adds a claim with a suffix that no other claim of the frame has. The first claim on tf gets an
// empty one, so earlier claims on tf_static get new suffixes.
FrameClaims::Claim& FrameClaims::add(const Publisher& publisher, Claims& claims) {
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
  return claims.emplace_back(Claim{.publisher = publisher, .suffix = suffix, .link = {}});
}

// Sorts the claim that is used to the front: tf before tf_static, then live before silent, then by
// number. A silent publisher on tf is not replaced by tf_static, which never ages.
void FrameClaims::choose(Claims& claims, std::int64_t monotonic_ns) {
  const auto rank = [&](const Claim& claim) {
    return std::tuple(claim.publisher.is_static, !is_live(claim, monotonic_ns), claim.suffix);
  };
  std::ranges::sort(claims, {}, rank);
}

bool FrameClaims::set(const std::string& child, const Publisher& publisher, TfTree::Link link,
                      std::int64_t monotonic_ns) {
  Claims& claims = claims_[child];
  auto claim = std::ranges::find(claims, publisher, &Claim::publisher);
  if (claim == claims.end()) {
    if (claims.size() >= kMostClaims) return true;
    add(publisher, claims);
    claim = claims.end() - 1;
    if (claims.size() == 2) disputed_.insert(child);
  }
  set_twist(claim->link, link);
  claim->link = std::move(link);
  claim->heard_ns = monotonic_ns;
  if (claims.size() > 1) choose(claims, monotonic_ns);
  tree_.set(child, claims.front().link);
  const auto differs = [&](const Claim& other) {
    return is_live(other, monotonic_ns) && !says_the_same(other.link, claims.front().link);
  };
  return std::any_of(claims.begin() + 1, claims.end(), differs);
}

// A frame without a publisher keeps its last transform, which ages.
void FrameClaims::keep(std::span<const std::uint64_t> writers) {
  for (auto& [child, claims] : claims_) {
    const std::size_t gone = std::erase_if(claims, [&](const Claim& claim) {
      return !std::ranges::binary_search(writers, claim.publisher.writer);
    });
    if (gone > 0 && !claims.empty()) tree_.set(child, claims.front().link);
  }
  std::erase_if(disputed_, [&](const std::string& child) {
    const Claims& claims = claims_[child];
    return claims.empty() || (claims.size() == 1 && claims.front().suffix.empty());
  });
}

// The frames may form a cycle, so the number of steps is limited.
std::vector<std::string> FrameClaims::disputed_on(const std::string& frame) const {
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

void FrameClaims::settle(std::int64_t monotonic_ns) {
  for (const std::string& child : disputed_) {
    Claims& claims = claims_[child];
    choose(claims, monotonic_ns);
    tree_.set(child, claims.front().link);
  }
}

}  // namespace clearance
