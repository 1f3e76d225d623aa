#include "tools/scene/allowed_collisions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "config/urdf/robot_exceptions.hpp"

namespace clearance {
namespace {

using Names = std::pair<std::string, std::string>;

Names names_of(const Scene& scene, const SampledPair& pair) {
  return {scene.objects[pair.first].name, scene.objects[pair.second].name};
}

const char* word(AllowedReason reason) {
  switch (reason) {
    case AllowedReason::kAdjacent:
      return "Adjacent";
    case AllowedReason::kDefault:
      return "Default";
    case AllowedReason::kAlways:
      return "Always";
    case AllowedReason::kNever:
      return "Never";
    case AllowedReason::kWatch:
      break;
  }
  return "watched";
}

// "in contact in 12 of 10000 positions"; for none of them, also the least distance.
std::string counts(const SampledPair& pair, std::uint64_t samples) {
  const std::string text = fmt::format("in contact in {} of {} positions", pair.touching, samples);
  return pair.touching > 0 ? text : fmt::format("{}, at least {:.4f} m apart", text, pair.least);
}

}  // namespace

AllowedReason reason_to_allow(const SampledPair& pair, const AllowRule& rule) {
  if (pair.adjacent) return AllowedReason::kAdjacent;
  if (pair.touch_at_zero) return AllowedReason::kDefault;
  if (20 * pair.touching >= 19 * rule.samples) return AllowedReason::kAlways;
  return pair.least > rule.never_margin ? AllowedReason::kNever : AllowedReason::kWatch;
}

std::string as_srdf(const Scene& scene, const std::vector<SampledPair>& pairs,
                    const AllowRule& rule) {
  std::string text = fmt::format("<robot name=\"{}\">\n", scene.robots.front().name);
  for (const SampledPair& pair : pairs) {
    const AllowedReason reason = reason_to_allow(pair, rule);
    if (reason == AllowedReason::kWatch) continue;
    const auto& [a, b] = names_of(scene, pair);
    text += fmt::format(
        "  <disable_collisions link1=\"{}\" link2=\"{}\" reason=\"{}\"/>  <!-- {} -->\n", a, b,
        word(reason), counts(pair, rule.samples));
  }
  return text + "</robot>\n";
}

std::string as_cell(const Scene& scene, const std::vector<SampledPair>& pairs,
                    const AllowRule& rule) {
  std::string text = "allowed_collisions:\n";
  for (const SampledPair& pair : pairs) {
    const AllowedReason reason = reason_to_allow(pair, rule);
    if (reason == AllowedReason::kWatch) continue;
    const auto& [a, b] = names_of(scene, pair);
    text += fmt::format("  - {{between: [\"{}\", \"{}\"], reason: \"{}: {}\"}}\n", a, b,
                        word(reason), counts(pair, rule.samples));
  }
  return text;
}

std::string near_misses(const Scene& scene, const std::vector<SampledPair>& pairs,
                        const AllowRule& rule) {
  std::string missed;
  for (const SampledPair& pair : pairs) {
    if (pair.touching > 0 || reason_to_allow(pair, rule) != AllowedReason::kWatch) continue;
    const auto& [a, b] = names_of(scene, pair);
    missed += fmt::format("  {} - {}: {:.4f} m\n", a, b, pair.least);
  }
  if (missed.empty()) return missed;
  return fmt::format(
      "near misses, which stay watched: no contact was sampled (--samples {}), but the least "
      "distance is within --never-margin {:g}\n{}",
      rule.samples, rule.never_margin, missed);
}

std::string agreement(const Scene& scene, const std::vector<SampledPair>& pairs,
                      const AllowRule& rule, const Srdf& srdf) {
  LinkNames shaped, fixed;
  for (const Object& object : scene.objects) {
    shaped.insert(object.name);
    if (object.fixed) fixed.insert(object.name);
  }
  std::set<Names> disabled;
  std::vector<std::string> notes;
  for (const SrdfDisabled& entry : exceptions_of(srdf, shaped, fixed, notes))
    disabled.insert(std::minmax(entry.link_a, entry.link_b));
  std::size_t both = 0, neither = 0;
  std::string only;
  for (const SampledPair& pair : pairs) {
    const auto [a, b] = names_of(scene, pair);
    const AllowedReason reason = reason_to_allow(pair, rule);
    const bool stock = disabled.contains(std::minmax(a, b));
    const bool ours = reason != AllowedReason::kWatch;
    both += stock && ours;
    neither += !stock && !ours;
    if (stock == ours) continue;
    only +=
        fmt::format("  {} - {}: {} the SRDF, {} here; {}\n", a, b,
                    stock ? "disabled in" : "watched by", word(reason), counts(pair, rule.samples));
  }
  return fmt::format(
      "{} of {} pairs as in the SRDF: {} left out by both, {} watched by both; {} pairs differ\n{}",
      both + neither, pairs.size(), both, neither, pairs.size() - both - neither, only);
}

}  // namespace clearance
