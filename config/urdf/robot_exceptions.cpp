// Faults and notes help a person who has the wrong file, or none: they name links and lines.
#include "config/urdf/robot_exceptions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

#include "config/text/sentences.hpp"

namespace clearance {

// An SRDF of another robot would disable unrelated pairs, and leave neighbours watched. Another
// name alone is no fault: MoveIt takes such a file, and vendors ship some.
UrdfFaults faults_of(Srdf& srdf, const std::filesystem::path& srdf_file, const UrdfRobot& robot,
                     const std::filesystem::path& urdf_file) {
  UrdfFaults faults;
  const auto refuse = [&](UrdfPlace place, const std::string& text) {
    faults.push_back(fault_at(srdf_file.string(), place, text));
  };
  const std::string urdf = urdf_file.filename().string();
  std::set<std::string> links;
  for (const UrdfLink& link : robot.links) links.insert(link.name);
  // Each name is checked once, at its first place.
  const auto check = [&](const std::string& link, UrdfPlace place) {
    if (!links.insert(link).second) return;
    refuse(place, fmt::format("found the link '{}'; expected one of the links of {}", link, urdf));
  };
  for (const std::vector<SrdfDisabled>* pairs : {&srdf.disabled, &srdf.enabled}) {
    for (const SrdfDisabled& entry : *pairs) {
      check(entry.link_a, entry.place);
      check(entry.link_b, entry.place);
    }
  }
  for (const SrdfDefault& entry : srdf.disabled_by_default) check(entry.link, entry.place);
  if (srdf.robot == robot.name) return faults;
  const std::string other = fmt::format("found the robot '{}'; expected '{}', as {} calls it",
                                        srdf.robot, robot.name, urdf);
  if (faults.empty()) {
    srdf.notes.push_back(
        fault_at(srdf_file.string(), srdf.place, other + ": all its links are there").text);
  } else {
    refuse(srdf.place, other);
    sort_by_place(faults);
  }
  return faults;
}

void note_visuals(const UrdfRobot& robot, std::vector<std::string>& notes) {
  std::vector<std::string> links;
  for (const UrdfLink& link : robot.links)
    if (link.collisions.empty() && link.has_visual) links.push_back(fmt::format("'{}'", link.name));
  if (links.empty()) return;
  notes.push_back(
      fmt::format("not watched, since they have a visual and no collision shape: {} "
                  "(a cell takes their visuals: visual_as_collision: [...])",
                  fmt::join(links, ", ")));
}

namespace {

using LinkPair = std::pair<std::string, std::string>;

LinkPair in_order(const std::string& a, const std::string& b) { return std::minmax(a, b); }

// Takes the pairs disabled by default, less the enabled ones, and the pairs disabled one by one.
// MoveIt does the same.
std::vector<SrdfDisabled> all_disabled(const Srdf& srdf, const LinkNames& shaped,
                                       std::vector<std::string>& notes) {
  std::vector<SrdfDisabled> all = srdf.disabled;
  if (srdf.disabled_by_default.empty()) return all;
  std::set<LinkPair> enabled, one_by_one;
  for (const SrdfDisabled& entry : srdf.enabled)
    enabled.insert(in_order(entry.link_a, entry.link_b));
  for (const SrdfDisabled& entry : srdf.disabled)
    one_by_one.insert(in_order(entry.link_a, entry.link_b));
  std::set<LinkPair> added;
  for (const SrdfDefault& entry : srdf.disabled_by_default) {
    if (!shaped.contains(entry.link)) continue;
    for (const std::string& other : shaped) {
      const LinkPair pair = in_order(entry.link, other);
      if (other == entry.link || enabled.contains(pair) || one_by_one.contains(pair)) continue;
      if (added.insert(pair).second)
        all.push_back({pair.first, pair.second, "disabled by default in the SRDF", entry.place});
    }
  }
  if (!added.empty()) {
    notes.push_back(fmt::format("{} disabled by default in the SRDF and not enabled",
                                counted(added.size(), "pair")));
  }
  return all;
}

}  // namespace

// The SRDF names links without shapes too, and sometimes a pair twice: neither becomes an
// exception.
std::vector<SrdfDisabled> exceptions_of(const Srdf& srdf, const LinkNames& shaped,
                                        const LinkNames& fixed, std::vector<std::string>& notes) {
  std::set<LinkPair> seen;
  std::vector<SrdfDisabled> useful;
  const std::vector<SrdfDisabled> disabled = all_disabled(srdf, shaped, notes);
  notes.insert(notes.end(), srdf.notes.begin(), srdf.notes.end());
  std::map<std::string, int> left_out;  // by reason
  for (const SrdfDisabled& entry : disabled) {
    if (!shaped.contains(entry.link_a) || !shaped.contains(entry.link_b)) {
      ++left_out["with a link without collision shapes"];
    } else if (entry.link_a == entry.link_b) {
      ++left_out["of a link with itself"];
    } else if (fixed.contains(entry.link_a) && fixed.contains(entry.link_b)) {
      ++left_out["of two fixed links"];
    } else if (!seen.insert(in_order(entry.link_a, entry.link_b)).second) {
      ++left_out["named twice"];
    } else {
      useful.push_back(entry);
    }
  }
  std::string reasons;
  for (const auto& [reason, count] : left_out) {
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  }
  if (!left_out.empty()) {
    notes.push_back(fmt::format(
        "{} left out: {}", counted(disabled.size() - useful.size(), "disabled pair"), reasons));
  }
  return useful;
}

// A link and its nearest ancestor that has shapes overlap by design. Links that merely share a
// frame need not overlap, so they stay watched.
std::vector<SrdfDisabled> neighbours_of(const UrdfRobot& robot, const LinkNames& shaped,
                                        const LinkNames& fixed, std::vector<std::string>& notes) {
  std::map<std::string, std::string> parents;
  for (const UrdfJoint& joint : robot.joints) parents[joint.child] = joint.parent;
  std::vector<SrdfDisabled> pairs;
  std::string names;
  for (const UrdfLink& link : robot.links) {
    if (!shaped.contains(link.name)) continue;
    auto above = parents.find(link.name);
    while (above != parents.end() && !shaped.contains(above->second)) {
      above = parents.find(above->second);
    }
    if (above == parents.end()) continue;
    const std::string& parent = above->second;
    if (fixed.contains(link.name) && fixed.contains(parent)) continue;
    pairs.push_back({parent, link.name, "Adjacent in the URDF"});
    names += fmt::format("{}{} - {}", names.empty() ? "" : ", ", parent, link.name);
  }
  notes.push_back(pairs.empty()
                      ? "no SRDF, and no neighbours: every pair of links is watched"
                      : fmt::format("no SRDF: these neighbours are not watched: {}", names));
  return pairs;
}

}  // namespace clearance
