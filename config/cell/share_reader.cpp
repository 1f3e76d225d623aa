#include "config/cell/share_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "config/cell/share_topics.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kNoShare = std::numeric_limits<std::uint32_t>::max();

class ShareReader {
 public:
  ShareReader(const std::vector<Object>& objects, const std::vector<ObjectPair>& pairs,
              GroupIndex& group_index, Diagnostics& diagnostics)
      : objects_(objects),
        pairs_(pairs),
        group_index_(group_index),
        diagnostics_(diagnostics),
        share_of_(pairs.size(), kNoShare) {}

  std::vector<Share> read(const YamlNode& node) {
    for (const YamlNode& item : read_list(node, "shares {name: N, pairs: [...]}", diagnostics_))
      read_share(item);
    if (is_complete_) refuse_left_out(node);
    if (!is_complete_) return {};
    for (std::uint32_t pair = 0; pair < share_of_.size(); ++pair)
      shares_[share_of_[pair]].pairs.push_back(pair);
    return std::move(shares_);
  }

 private:
  void read_share(const YamlNode& node) {
    MapReader map(node, "a share", diagnostics_);
    const YamlNode* name_node = map.required("name");
    const YamlNode* pairs_node = map.required("pairs");
    map.refuse_unknown_keys();
    Share share;
    if (name_node != nullptr) share.name = read_share_name(*name_node);
    const auto index = static_cast<std::uint32_t>(shares_.size());
    shares_.push_back(std::move(share));
    if (name_node == nullptr || pairs_node == nullptr || shares_.back().name.empty())
      is_complete_ = false;
    if (shares_.size() == kMaxShares + 1) {
      refuse(node, fmt::format("found more than {0} shares; expected at most {0}", kMaxShares));
    }
    if (pairs_node == nullptr) return;
    std::size_t taken = 0;
    for (const YamlNode& rule :
         read_list(*pairs_node, "rules {between: [A, B]} of a share", diagnostics_)) {
      taken += read_rule(rule, index);
    }
    if (taken == 0 && is_complete_)
      refuse(node, fmt::format("found no watched pair in the share '{}'; expected at least one",
                               shares_.back().name));
  }

  // Names stand in topics and in the announcements of daemons. Two that differ only in characters
  // that no topic has would share their topics.
  std::string read_share_name(const YamlNode& node) {
    const auto name = read_name(node, "a share's name", diagnostics_);
    if (!name) return {};
    if (name->size() > kMaxShareName || name->find('/') != std::string::npos) {
      refuse(node, fmt::format("found {}; expected a name of 1 to {} bytes without '/'",
                               describe(node), kMaxShareName));
      return {};
    }
    const auto [same, is_new] = topics_.emplace(share_topic("", *name), &node);
    if (!is_new) {
      refuse(node, fmt::format("found {}, whose topics would be those of the share in line {}; "
                               "expected names that differ in letters, digits or '_'",
                               describe(node), same->second->line));
      return {};
    }
    return *name;
  }

  // Returns how many pairs it added.
  std::size_t read_rule(const YamlNode& node, std::uint32_t share) {
    MapReader map(node, "a rule of a share", diagnostics_);
    const auto between = group_index_.read_between(map);
    map.refuse_unknown_keys();
    if (!between) {
      is_complete_ = false;
      return 0;
    }
    std::size_t added = 0;
    for (const PairKey key : group_index_.pairs(*between)) {
      const auto pair = pair_index(pairs_, key);
      if (!pair || share_of_[*pair] == share) continue;
      if (share_of_[*pair] != kNoShare) {
        refuse(node,
               fmt::format("found {} in the shares '{}' and '{}'; expected every pair in one "
                           "share",
                           described(*pair), shares_[share_of_[*pair]].name, shares_[share].name));
        return added;
      }
      share_of_[*pair] = share;
      ++added;
    }
    return added + (between->may_be_empty ? 1 : 0);
  }

  void refuse_left_out(const YamlNode& node) {
    const auto first = std::ranges::find(share_of_, kNoShare);
    if (first == share_of_.end()) return;
    const auto count = std::ranges::count(share_of_, kNoShare);
    refuse(node, fmt::format("found no share for {}{}; expected every watched pair in one share",
                             described(static_cast<std::uint32_t>(first - share_of_.begin())),
                             count > 1 ? fmt::format(" and {} other pairs", count - 1) : ""));
  }

  [[nodiscard]] std::string described(std::uint32_t pair) const {
    const ObjectPair& of = pairs_[pair];
    return fmt::format("the pair '{}' and '{}'", objects_[of.first].name, objects_[of.second].name);
  }

  void refuse(const YamlNode& node, std::string what) {
    diagnostics_.add(node, std::move(what));
    is_complete_ = false;
  }

  const std::vector<Object>& objects_;
  const std::vector<ObjectPair>& pairs_;
  GroupIndex& group_index_;
  Diagnostics& diagnostics_;
  std::vector<std::uint32_t> share_of_;            // by pair
  std::map<std::string, const YamlNode*> topics_;  // of the shares, and where they are named
  std::vector<Share> shares_;
  bool is_complete_ = true;
};

std::vector<Share> read_balanced(const YamlNode& node, const std::vector<Object>& objects,
                                 const std::vector<ObjectPair>& pairs, Diagnostics& diagnostics) {
  MapReader map(node, "the shares", diagnostics);
  const YamlNode* count_node = map.required("auto");
  map.refuse_unknown_keys();
  if (count_node == nullptr) return {};
  const auto count =
      read_integer(*count_node, 1, kMaxShares, "shares of about the same cost", diagnostics);
  if (!count || pairs.empty()) return {};
  std::vector<Share> shares = balanced_shares(objects, pairs, static_cast<std::uint32_t>(*count));
  if (std::ranges::any_of(shares, [](const Share& share) { return share.pairs.empty(); })) {
    diagnostics.add(*count_node, fmt::format("found {} shares for {} pairs of such different cost "
                                             "that one would be empty; expected fewer",
                                             *count, pairs.size()));
    return {};
  }
  return shares;
}

}  // namespace

std::vector<Share> read_shares(const YamlNode& node, const std::vector<Object>& objects,
                               const std::vector<ObjectPair>& pairs, const std::vector<Zone>& zones,
                               GroupIndex& group_index, Diagnostics& diagnostics) {
  std::vector<Share> shares =
      node.kind == YamlNode::Kind::kMap
          ? read_balanced(node, objects, pairs, diagnostics)
          : ShareReader(objects, pairs, group_index, diagnostics).read(node);
  if (!shares.empty()) note_zones(zones, shares);
  return shares;
}

}  // namespace clearance
