// The topics of a share of a cell.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "config/cell/topics.hpp"

namespace clearance {

// "clearance/distances/share/left". Characters that no topic has are '_'.
[[nodiscard]] inline std::string share_topic(std::string_view topic, std::string_view share) {
  std::string name = std::string(topic) + "/share/";
  for (const char c : share) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    name += is_plain ? c : '_';
  }
  return name;
}

// Returns the topic of the share `other`, given `topic` of `share`.
[[nodiscard]] inline std::string topic_of_other_share(std::string_view topic,
                                                      std::string_view share,
                                                      std::string_view other) {
  topic.remove_suffix(share_topic("", share).size());
  return share_topic(topic, other);
}

// Inputs are those of the cell, which the daemons of all shares read.
[[nodiscard]] inline Topics topics_of_share(const Topics& topics, std::string_view share) {
  constexpr std::array kInputs = {&Topics::poses, &Topics::joint_states};
  Topics own = topics;
  for (const TopicKey& key : kTopicKeys) {
    if (std::ranges::find(kInputs, key.name) != kInputs.end()) continue;
    own.*key.name = share_topic(topics.*key.name, share);
  }
  return own;
}

}  // namespace clearance
