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

// `shares: {auto: N}`, and with `begin:` where the runs begin.
class BalancedReader {
 public:
  BalancedReader(const std::vector<Object>& objects, const std::vector<ObjectPair>& pairs,
                 Diagnostics& diagnostics)
      : objects_(objects), pairs_(pairs), diagnostics_(diagnostics) {}

  std::vector<Share> read(const YamlNode& node) {
    MapReader map(node, "the shares", diagnostics_);
    const YamlNode* count_node = map.required("auto");
    const YamlNode* begin_node = map.optional("begin");
    map.refuse_unknown_keys();
    if (count_node == nullptr) return {};
    const auto count =
        read_integer(*count_node, 1, kMaxShares, "shares of about the same cost", diagnostics_);
    if (!count || pairs_.empty()) return {};
    const auto begins =
        begin_node == nullptr
            ? balanced_begins(expected_costs(objects_, pairs_), static_cast<std::uint32_t>(*count))
            : read_begins(*begin_node, static_cast<std::size_t>(*count) - 1);
    if (!begins) return {};
    std::vector<Share> shares = shares_of_runs(pairs_.size(), *begins);
    if (std::ranges::any_of(shares, [](const Share& share) { return share.pairs.empty(); })) {
      diagnostics_.add(*count_node, fmt::format("found {} shares for {} pairs: one would be empty; "
                                                "expected fewer",
                                                *count, pairs_.size()));
      return {};
    }
    return shares;
  }

 private:
  // Each entry names two objects. Their pair begins a share, or the next pair does if the cell does
  // not watch theirs.
  std::optional<std::vector<std::uint32_t>> read_begins(const YamlNode& node, std::size_t count) {
    const std::vector<YamlNode>& items = read_list(node, "two objects [A, B]", diagnostics_);
    if (items.size() != count) {
      diagnostics_.add(node, fmt::format("found {} first pairs; expected {}, one for each share "
                                         "after the first",
                                         items.size(), count));
      return std::nullopt;
    }
    std::vector<std::uint32_t> begins;
    for (const YamlNode& item : items) {
      const auto key = read_pair(item);
      if (!key) return std::nullopt;
      begins.push_back(first_from(*key));
      if (begins.size() > 1 && begins.back() < begins[begins.size() - 2]) {
        diagnostics_.add(item,
                         "found a first pair that stands before that of the share before; "
                         "expected them in the order of the cell's pairs, as 'clearance-replay "
                         "check --balance' prints them");
        return std::nullopt;
      }
    }
    return begins;
  }

  std::optional<PairKey> read_pair(const YamlNode& node) {
    const std::vector<YamlNode>& names = read_list(node, "two objects [A, B]", diagnostics_);
    std::vector<std::uint32_t> found;
    for (const YamlNode& name_node : names) {
      const auto name = read_name(name_node, "an object's name", diagnostics_);
      if (!name) return std::nullopt;
      const auto object = std::ranges::find(objects_, *name, &Object::name);
      if (object == objects_.end()) {
        diagnostics_.add(name_node, fmt::format("found no object '{}'; expected one of the cell, "
                                                "since a share begins at its pair",
                                                *name));
        return std::nullopt;
      }
      found.push_back(static_cast<std::uint32_t>(object - objects_.begin()));
    }
    if (found.size() == 2) return pair_key(found[0], found[1]);
    diagnostics_.add(node, fmt::format("found {}; expected two objects [A, B]", describe(node)));
    return std::nullopt;
  }

  [[nodiscard]] std::uint32_t first_from(PairKey key) const {
    const auto first = std::ranges::lower_bound(
        pairs_, key, {}, [](const ObjectPair& pair) { return pair_key(pair.first, pair.second); });
    return static_cast<std::uint32_t>(first - pairs_.begin());
  }

  const std::vector<Object>& objects_;
  const std::vector<ObjectPair>& pairs_;
  Diagnostics& diagnostics_;
};

}  // namespace

std::vector<Share> read_shares(const YamlNode& node, const std::vector<Object>& objects,
                               const std::vector<ObjectPair>& pairs, const std::vector<Zone>& zones,
                               GroupIndex& group_index, Diagnostics& diagnostics) {
  std::vector<Share> shares =
      node.kind == YamlNode::Kind::kMap
          ? BalancedReader(objects, pairs, diagnostics).read(node)
          : ShareReader(objects, pairs, group_index, diagnostics).read(node);
  if (!shares.empty()) note_zones(zones, shares);
  return shares;
}

}  // namespace clearance
