#include "monitor/recording/given_joints.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
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

std::string read_joint_positions(const std::vector<std::string>& texts,
                                 std::map<std::string, double>& positions) {
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    double position = 0.0;
    const char* const end = text.data() + text.size();
    const bool is_number = equals != std::string::npos && equals > 0 &&
                           std::from_chars(text.data() + equals + 1, end, position).ptr == end &&
                           equals + 1 < text.size() && std::isfinite(position);
    if (!is_number)
      return fmt::format("--joint: found '{}'; expected NAME=POSITION, in rad or m", text);
    if (!positions.emplace(text.substr(0, equals), position).second) {
      return fmt::format("--joint: '{}' is given twice", text.substr(0, equals));
    }
  }
  return {};
}

void note_unheard(const Scene& scene, const std::set<std::string>& heard,
                  const std::map<std::string, double>& given, std::vector<std::string>& notes) {
  std::string names;
  for (const JointVariable& variable : scene.variables) {
    const std::string& name = variable.name;
    if (!heard.contains(name) && !given.contains(name)) names += (names.empty() ? "" : ", ") + name;
  }
  if (names.empty()) return;
  notes.push_back(fmt::format(
      "nothing says where these joints are, and what hangs on them is unknown: {}; --joint "
      "NAME=POSITION says where one stays",
      names));
}

}  // namespace clearance
