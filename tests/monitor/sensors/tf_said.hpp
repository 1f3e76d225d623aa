// Transforms that a test makes up, and what they say of past times.
#pragma once

#include <optional>
#include <string>

#include "monitor/intake/tf_frames.hpp"

namespace clearance::test {

struct TfSaid {
  TfFrames frames{256};

  void add(const std::string& child, const std::string& parent, const Pose& pose,
           std::int64_t stamp_ns, bool is_static, std::uint64_t writer = 1) {
    TfTree::Link link{.parent = parent, .parent_from_child = pose, .stamp_ns = std::nullopt};
    if (!is_static) link.stamp_ns = stamp_ns;
    if (!TfFrames::is_transform(child, link)) return;
    frames.set(child, {.writer = writer, .is_static = is_static}, std::move(link), stamp_ns);
  }
  [[nodiscard]] std::optional<TfFrames::Step> step(const std::string& child, std::int64_t stamp_ns,
                                                   std::int64_t within_ns = 0) const {
    const TfFrames::Claim* const claim = frames.used(child);
    return claim == nullptr ? std::nullopt : TfFrames::step(*claim, stamp_ns, within_ns);
  }
};

}  // namespace clearance::test
