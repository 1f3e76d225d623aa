// The names in an SRDF are replaced by those of the cell; then it is one as any other.
#include "config/cell/combined_srdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/link_parts.hpp"
#include "config/cell/robot_description.hpp"
#include "config/text/spelling.hpp"
#include "config/urdf/robot_exceptions.hpp"
#include "config/urdf/urdf.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// The robots of a combination: the one that carries, and the one that is carried.
using Combined = std::array<const Robot*, 2>;

// Tells whether the robot stands on a link of this one, or on what stands there.
bool stands_on(std::span<const Robot> before, std::size_t carrier, const Robot& robot) {
  for (const Robot* at = &robot;; at = &before[at->base.robot]) {
    const bool on_link = at->base.kind == RobotBase::Kind::kLink ||
                         at->base.resting_on.kind == RestingOn::Kind::kLink;
    if (!on_link) return false;
    if (at->base.robot == carrier) return true;
  }
}

// Replaces the names of links by those of the cell.
class CellNames {
 public:
  CellNames(const Combined& robots, std::string file) : robots_(robots), file_(std::move(file)) {}

  UrdfFaults put_into(Srdf& srdf) {
    for (std::vector<SrdfDisabled>* pairs : {&srdf.disabled, &srdf.enabled}) {
      for (SrdfDisabled& pair : *pairs) {
        put(pair.place, pair.link_a);
        put(pair.place, pair.link_b);
      }
    }
    for (SrdfDefault& each : srdf.disabled_by_default) put(each.place, each.link);
    return std::move(faults_);
  }

 private:
  void put(UrdfPlace place, std::string& link) {
    std::set<std::string> found;
    std::vector<std::string> names;
    for (const Robot* robot : robots_) {
      for (const RobotLink& each : robot->links) {
        names.push_back(each.name);
        if (each.name == link || each.name == robot->prefix + link) found.insert(each.name);
      }
    }
    // A name of the cell counts first.
    if (found.size() > 1 && found.contains(link)) found = {link};
    if (found.size() == 1) {
      link = *found.begin();
    } else if (refused_.insert(link).second) {
      faults_.push_back(fault_at(
          file_, place,
          fmt::format("found the link '{}', which {} has; expected one of the links of '{}' or "
                      "'{}'{}",
                      link, found.empty() ? "neither robot" : "each of both robots",
                      robots_[0]->name, robots_[1]->name, did_you_mean(link, names))));
    }
  }

  Combined robots_;
  std::string file_;
  std::set<std::string> refused_;
  UrdfFaults faults_;
};

void allow(const Srdf& srdf, const Combined& robots, int line, std::vector<std::string>& notes,
           PairExceptions& may_touch) {
  LinkNames shaped;
  std::map<std::string, std::uint32_t> objects;
  for (const Robot* robot : robots) {
    for (const RobotLink& link : robot->links) {
      if (link.object == RobotLink::kNoObject) continue;
      shaped.insert(link.name);
      objects.emplace(link.name, link.object);
    }
  }
  for (const SrdfDisabled& pair : exceptions_of(srdf, shaped, {}, notes))
    may_touch.emplace_back(pair_key(objects[pair.link_a], objects[pair.link_b]), line);
}

}  // namespace

void read_combined_srdfs(const YamlNode& node, const RobotFiles& files,
                         std::span<const Robot> before, int line, Robot& robot,
                         PairExceptions& may_touch, Diagnostics& diagnostics, Revision& revision) {
  if (node.kind != YamlNode::Kind::kMap) {
    diagnostics.add(node, fmt::format("found {}; expected robots and the SRDFs of this one with "
                                      "them: {{ROBOT: FILE}}",
                                      describe(node)));
  }
  std::vector<std::string> names;
  for (const Robot& each : before) names.push_back(each.name);
  for (const YamlEntry& entry : node.entries) {
    const auto name = read_name(entry.key, "a robot's name", diagnostics);
    const auto path = find_robot_file(entry.value, files, diagnostics, revision);
    if (!name || !path) continue;
    const auto carrier = std::ranges::find(before, *name, &Robot::name);
    if (carrier == before.end()) {
      diagnostics.add(entry.key,
                      fmt::format("found the unknown robot '{}'; expected one that stands before "
                                  "this one{}",
                                  *name, did_you_mean(*name, names)));
      continue;
    }
    auto read = read_srdf(*path);
    if (const auto* faults = std::get_if<UrdfFaults>(&read)) {
      refuse_robot(entry.value, *faults, diagnostics);
      continue;
    }
    auto& srdf = std::get<Srdf>(read);
    const Combined robots{&*carrier, &robot};
    refuse_robot(entry.value, CellNames(robots, path->string()).put_into(srdf), diagnostics);
    const auto place = static_cast<std::size_t>(carrier - before.begin());
    if (stands_on(before, place, robot)) allow(srdf, robots, line, robot.notes, may_touch);
  }
}

}  // namespace clearance
