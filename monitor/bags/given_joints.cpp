#include "monitor/bags/given_joints.hpp"

#include <fmt/format.h>

#include "config/spelling.hpp"
#include "monitor/wire/joint_names.hpp"

namespace clearance {

GivenJoints::GivenJoints(const Scene& scene, const std::map<std::string, double>& positions) {
  batch_.source = SourceName("given");
  const JointNames names(scene);
  for (const auto& [name, position] : positions) {
    const std::uint32_t variable = names.find(name);
    if (variable < scene.variables.size()) {
      JointSample& sample = batch_.joints.emplace_back();
      sample.variable = variable;
      sample.position = position;
      continue;
    }
    const std::vector<std::string> known = joint_names(scene);
    error_ = fmt::format("no joint '{}' moves in this cell{}; expected one of {}", name,
                         did_you_mean(name, known), known.empty() ? "none" : one_of(known));
    return;
  }
}

PoseBatch GivenJoints::at(std::int64_t stamp_ns) {
  ++batch_.sequence_number;
  for (JointSample& sample : batch_.joints) sample.stamp_ns = stamp_ns;
  return batch_;
}

std::vector<std::string> joint_names(const Scene& scene) {
  std::vector<std::string> names;
  for (const JointVariable& variable : scene.variables) names.push_back(variable.name);
  return names;
}

void note_unheard(const Scene& scene, const std::vector<bool>& heard,
                  const std::map<std::string, double>& given, std::vector<std::string>& notes) {
  std::string names;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const std::string& name = scene.variables[i].name;
    if (!heard[i] && !given.contains(name)) names += (names.empty() ? "" : ", ") + name;
  }
  if (names.empty()) return;
  notes.push_back(fmt::format(
      "nothing says where these joints are, and what hangs on them is unknown: {}; --joint "
      "NAME=POSITION says where one stays",
      names));
}

}  // namespace clearance
