// Faults and notes are made for people who have the wrong file, or none: they name links and lines.
#include "config/robot_exceptions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "config/utf8.hpp"

namespace clearance {

// An SRDF of another robot disables pairs that have nothing to do with this one, and leaves
// neighbours watched.
UrdfFaults faults_of(const Srdf& srdf, const std::filesystem::path& srdf_file,
                     const UrdfRobot& robot, const std::filesystem::path& urdf_file) {
  UrdfFaults faults;
  const auto refuse = [&](int line, const std::string& text) {
    faults.push_back({line, fmt::format("{}:{}: {}", srdf_file.string(), line, printable(text))});
  };
  const std::string urdf = urdf_file.filename().string();
  if (srdf.robot != robot.name) {
    refuse(srdf.line, fmt::format("found the robot '{}'; expected '{}', as {} calls it", srdf.robot,
                                  robot.name, urdf));
  }
  std::set<std::string> links;
  for (const UrdfLink& link : robot.links) links.insert(link.name);
  for (const SrdfDisabled& entry : srdf.disabled) {
    for (const std::string& link : {entry.link_a, entry.link_b}) {
      // Each name once, where it stands first.
      if (!links.insert(link).second) continue;
      refuse(entry.line,
             fmt::format("found the link '{}'; expected one of the links of {}", link, urdf));
    }
  }
  return faults;
}

// The SRDF speaks of links without shapes too, and sometimes of a pair twice: neither is an
// exception of ours.
std::vector<SrdfDisabled> exceptions_of(const Srdf& srdf, const LinkNames& shaped,
                                        const LinkNames& fixed, std::vector<std::string>& notes) {
  std::set<std::pair<std::string, std::string>> seen;
  std::vector<SrdfDisabled> useful;
  std::map<std::string, int> left_out;  // by reason
  for (const SrdfDisabled& entry : srdf.disabled) {
    if (!shaped.contains(entry.link_a) || !shaped.contains(entry.link_b)) {
      ++left_out["with a link without collision shapes"];
    } else if (entry.link_a == entry.link_b) {
      ++left_out["of a link with itself"];
    } else if (fixed.contains(entry.link_a) && fixed.contains(entry.link_b)) {
      ++left_out["of two fixed links"];
    } else if (!seen.insert(std::minmax(entry.link_a, entry.link_b)).second) {
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
    notes.push_back(fmt::format("{} disabled pairs left out: {}",
                                srdf.disabled.size() - useful.size(), reasons));
  }
  return useful;
}

// A link and the next one above it that has shapes: what joins them overlaps by design. Of links
// that only hang on the same frame nothing is known, so they stay watched.
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
    pairs.push_back({parent, link.name, "Adjacent in the URDF", 0});
    names += fmt::format("{}{} - {}", names.empty() ? "" : ", ", parent, link.name);
  }
  notes.push_back(
      pairs.empty() ? "no SRDF, and no neighbours: every pair of links is watched"
                    : fmt::format("no SRDF: neighbours are left out, and every other pair of links "
                                  "is watched: {}",
                                  names));
  return pairs;
}

}  // namespace clearance
