// Rules add candidates, which are then sorted and made unique; exceptions mark candidates as
// allowed. The unmarked candidates are the pairs of the scene.
#include "config/cell/pair_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "config/cell/robot_reader.hpp"
#include "config/scene/people.hpp"

namespace clearance {
namespace {

// Reads rules first, then exceptions from them; finish() makes the rest the pairs of the scene.
class PairReader {
 public:
  PairReader(const ObjectList& objects, const RobotList& robots, GroupIndex& group_index,
             Diagnostics& diagnostics)
      : objects_(objects),
        robots_(robots),
        group_index_(group_index),
        diagnostics_(diagnostics),
        without_motion_(objects.objects.size(), false) {}

  void read_rules(const YamlNode& node);
  void allow_by_descriptions();
  void read_exceptions(const YamlNode& node);
  PairList finish(const YamlNode& rules);

 private:
  enum class Publish : std::uint8_t { kYes, kOpen, kNo };  // the first of two rules counts
  // A watched pair while the exceptions are read.
  struct Candidate {
    PairKey key;
    Publish publish;
    int allowed_line;  // of the exception that removed it; 0: none
  };

  void read_rule(const YamlNode& node);
  void read_exception(const YamlNode& node);
  Candidate* find(PairKey key);
  std::optional<std::string> why_never(PairKey key) const;
  std::string why_nothing(const Between& between, const std::vector<PairKey>& keys);
  void note_without_motion(const Between& between);
  void refuse_unwatched_objects() const;

  const ObjectList& objects_;
  const RobotList& robots_;
  GroupIndex& group_index_;
  Diagnostics& diagnostics_;
  // Sorted by key once the rules have been read.
  std::vector<Candidate> candidates_;
  std::vector<bool> without_motion_;  // by object: named by a rule that watches others of its group
  std::vector<NamedPair> rules_, exceptions_;
  // False after a rule that could not be read.
  bool complete_ = true;
};

// Adds all pairs of one rule. A rule that cannot be read leaves the list incomplete. Checks that
// need a complete list are then left out, since their reports would only follow from the first
// mistake.
void PairReader::read_rule(const YamlNode& node) {
  MapReader map(node, "a rule for pairs", diagnostics_);
  const auto between = group_index_.read_between(map);
  Publish publish = Publish::kOpen;
  if (const YamlNode* flag = map.optional("publish")) {
    publish = read_flag(*flag, diagnostics_).value_or(true) ? Publish::kYes : Publish::kNo;
  }
  map.refuse_unknown_keys();
  if (!between) {
    complete_ = false;
    return;
  }
  rules_.push_back({between->names[0], between->names[1]});
  const std::vector<PairKey> keys = group_index_.pairs(*between);
  if (keys.empty() && !between->may_be_empty) {
    diagnostics_.add(node, fmt::format("found no pair between '{}' and '{}'; expected at least two "
                                       "different objects, one of them moving",
                                       between->names[0], between->names[1]));
  }
  if (!keys.empty()) note_without_motion(*between);
  for (const PairKey key : keys) candidates_.push_back({key, publish, 0});
}

// A pair of two rules is one pair, published when either rule says so.
void PairReader::read_rules(const YamlNode& node) {
  if (node.kind == YamlNode::Kind::kSequence && node.items.empty()) {
    diagnostics_.add(node, "found an empty list; expected at least one rule: {between: [A, B]}");
  }
  for (const YamlNode& item : read_list(node, "rules {between: [A, B]}", diagnostics_))
    read_rule(item);
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(a.key, a.publish) < std::pair(b.key, b.publish);
  });
  const auto same = [](const Candidate& a, const Candidate& b) { return a.key == b.key; };
  candidates_.erase(std::unique(candidates_.begin(), candidates_.end(), same), candidates_.end());
  complete_ = complete_ && node.kind == YamlNode::Kind::kSequence;
  if (complete_ && objects_.names_known) refuse_unwatched_objects();
}

// Such an object of a rule has nothing to meet: its only partners may be fixed, or stand on the
// same body.
void PairReader::note_without_motion(const Between& between) {
  const auto is_rigid = [&](std::uint32_t object) {
    return std::ranges::any_of(objects_.rigid, [&](PairKey key) {
      return first_of(key) == object || second_of(key) == object;
    });
  };
  for (const std::vector<std::uint32_t>* side : between.objects) {
    for (const std::uint32_t object : *side)
      if (objects_.objects[object].fixed || is_rigid(object)) without_motion_[object] = true;
  }
}

// An object that no rule covers could be a robot link without any monitored pair.
void PairReader::refuse_unwatched_objects() const {
  std::vector<bool> watched = without_motion_;
  for (const Candidate& candidate : candidates_) {
    watched[first_of(candidate.key)] = watched[second_of(candidate.key)] = true;
  }
  for (std::size_t i = 0; i < watched.size(); ++i) {
    if (watched[i]) continue;
    diagnostics_.add(*objects_.places[i],
                     fmt::format("found the object '{}', which no rule under 'pairs' covers; "
                                 "expected every object to be watched against some other",
                                 objects_.objects[i].name));
  }
}

// Candidates are sorted by key.
PairReader::Candidate* PairReader::find(PairKey key) {
  const auto found = std::lower_bound(candidates_.begin(), candidates_.end(), key,
                                      [](const Candidate& a, PairKey b) { return a.key < b; });
  return found != candidates_.end() && found->key == key ? &*found : nullptr;
}

// Zones, which refuse more of these pairs, are read later.
std::optional<std::string> PairReader::why_never(PairKey key) const {
  return contact_with_people(objects_.objects, robots_.robots, {}, {}, first_of(key),
                             second_of(key));
}

// Many of these pairs are not watched anyway, since a description lists them for a whole robot. A
// person and a robot stay watched.
void PairReader::allow_by_descriptions() {
  for (const auto& [key, line] : robots_.may_touch) {
    Candidate* candidate = find(key);
    if (candidate != nullptr && candidate->allowed_line == 0 && !why_never(key))
      candidate->allowed_line = line;
  }
}

// Returns why an exception removes nothing, as the end of a sentence.
std::string PairReader::why_nothing(const Between& between, const std::vector<PairKey>& keys) {
  if (keys.empty()) {
    const bool itself =
        *between.objects[0] == *between.objects[1] && between.objects[0]->size() == 1;
    if (itself) return "an object has no pair with itself";
    return objects_.left_out.empty() ? "two fixed objects never make a pair"
                                     : "two fixed objects never make a pair, nor does what "
                                       "is fixed to another or may touch it";
  }
  for (const PairKey key : keys) {
    if (const Candidate* candidate = find(key)) {
      return fmt::format("line {} has already allowed it", candidate->allowed_line);
    }
  }
  return "no rule under 'pairs' covers it";
}

// Marks the pairs of one exception. Only the first exception of a pair is kept; a second one that
// removes nothing new is refused with the line of the first.
void PairReader::read_exception(const YamlNode& node) {
  MapReader map(node, "an allowed collision", diagnostics_);
  const auto between = group_index_.read_between(map, GroupIndex::Attached::kDoNot);
  const YamlNode* reason_node = map.required("reason");
  map.refuse_unknown_keys();
  if (reason_node != nullptr) {
    const auto reason = read_text(*reason_node, "the reason why these may touch", diagnostics_);
    if (reason && reason->find_first_not_of(" \t\n") == std::string::npos) {
      diagnostics_.add(*reason_node, "found an empty reason; expected why these may touch");
    }
  }
  if (!between) return;
  exceptions_.push_back({between->names[0], between->names[1]});
  const std::vector<PairKey> keys = group_index_.pairs(*between);
  bool removed = false;
  for (const PairKey key : keys) {
    Candidate* candidate = find(key);
    if (candidate == nullptr || candidate->allowed_line != 0) continue;
    if (const auto why = why_never(key)) return diagnostics_.add(node, *why);
    candidate->allowed_line = node.line;
    removed = true;
  }
  if (!removed && complete_ && !between->may_be_empty && !group_index_.has_rigid(*between)) {
    diagnostics_.add(
        node,
        fmt::format("found an exception that changes nothing: '{}' against '{}' is not watched "
                    "anyway, since {}; expected a watched pair, perhaps misspelt here",
                    between->names[0], between->names[1], why_nothing(*between, keys)));
  }
}

// Exceptions are read in the order of the file: of two equal ones, the second is refused.
void PairReader::read_exceptions(const YamlNode& node) {
  for (const YamlNode& item :
       read_list(node, "exceptions {between: [A, B], reason: ...}", diagnostics_)) {
    read_exception(item);
  }
}

// Candidates are sorted by key, hence so are both lists.
PairList PairReader::finish(const YamlNode& rules) {
  PairList list;
  list.complete = complete_;
  list.rules = std::move(rules_);
  list.exceptions = std::move(exceptions_);
  std::size_t published = 0;
  for (const Candidate& candidate : candidates_) {
    if (candidate.allowed_line != 0) {
      list.allowed.push_back(candidate.key);
      continue;
    }
    const bool publish = candidate.publish == Publish::kYes;
    if (candidate.publish == Publish::kOpen)
      list.open.push_back(static_cast<std::uint32_t>(list.pairs.size()));
    list.pairs.push_back({first_of(candidate.key), second_of(candidate.key), publish});
    published += publish ? 1 : 0;
  }
  if (published > kMaxPublished) {
    diagnostics_.add(
        rules, fmt::format(
                   "found {} pairs with publish: true; expected at most {}, which is what a report "
                   "can carry: leave it out at some rules (their pairs are watched all the same)",
                   published, kMaxPublished));
  }
  if (list.pairs.empty() && !candidates_.empty()) {
    diagnostics_.add(rules, "found every pair allowed to touch; expected at least one to watch");
  }
  return list;
}

}  // namespace

std::optional<std::uint32_t> pair_index(const std::vector<ObjectPair>& pairs, PairKey key) {
  const auto found = std::lower_bound(
      pairs.begin(), pairs.end(), key,
      [](const ObjectPair& a, PairKey b) { return pair_key(a.first, a.second) < b; });
  if (found == pairs.end() || pair_key(found->first, found->second) != key) return std::nullopt;
  return static_cast<std::uint32_t>(found - pairs.begin());
}

// Exceptions are read after all rules: they refer to what the rules as a whole watch.
PairList read_pairs(const YamlNode& pairs, const YamlNode* allowed, const ObjectList& objects,
                    const RobotList& robots, GroupIndex& group_index, Diagnostics& diagnostics) {
  PairReader reader(objects, robots, group_index, diagnostics);
  reader.read_rules(pairs);
  reader.allow_by_descriptions();
  if (allowed != nullptr) reader.read_exceptions(*allowed);
  return reader.finish(pairs);
}

}  // namespace clearance
