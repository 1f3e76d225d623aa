#include "tools/ask/motion_json.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <vector>

namespace clearance {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

std::vector<double> rows_of(const Json& line, const char* key, std::size_t columns) {
  std::vector<double> numbers;
  for (const Json& row : line.at(key)) {
    if (row.size() != columns) {
      throw BadMotion(fmt::format("a row of \"{}\" has {} numbers; expected {}, one for each joint",
                                  key, row.size(), columns));
    }
    for (const Json& number : row) numbers.push_back(number.get<double>());
  }
  return numbers;
}

Pose pose_of(const Json& numbers) {
  const auto n = numbers.get<std::array<double, 7>>();
  Pose pose;
  pose.position = {n[0], n[1], n[2]};
  pose.orientation = Eigen::Quaterniond(n[3], n[4], n[5], n[6]);
  return pose;
}

OthersMove others_of(const std::string& text) {
  if (text == "max_speed") return OthersMove::kWithinMaxSpeed;
  if (text == "still") return OthersMove::kNot;
  throw BadMotion("\"others\" is \"" + text + "\"; expected \"max_speed\" or \"still\"");
}

OrderedJson names_of(const Scene& scene, std::uint32_t first, std::uint32_t second) {
  return {scene.objects[first].name, scene.objects[second].name};
}

OrderedJson first_below(const MarginAnswer& margin, const Scene& scene) {
  if (margin.verdict == Verdict::kFree) return nullptr;
  OrderedJson entry;
  if (margin.verdict == Verdict::kBelow) {
    entry["t"] = {margin.above_until, margin.below_at};
  } else {
    entry["t"] = "undecided";
    entry["above_until"] = margin.above_until;
  }
  entry["pair"] = names_of(scene, margin.first, margin.second);
  return entry;
}

}  // namespace

Question read_question(const Json& line, const Question& defaults) {
  if (!line.is_object()) throw BadMotion("the line is not a JSON object");
  Question question = defaults;
  JointTrajectory& motion = question.motion;
  motion.joints = line.at("joints").get<std::vector<std::string>>();
  motion.times = line.at("times_s").get<std::vector<double>>();
  motion.positions = rows_of(line, "positions", motion.joints.size());
  if (line.contains("velocities")) {
    motion.velocities = rows_of(line, "velocities", motion.joints.size());
  }
  if (line.contains("held")) {
    for (const auto& [name, position] : line["held"].items()) {
      question.held.push_back({name, position.get<double>()});
    }
  }
  if (line.contains("poses")) {
    for (const auto& [name, pose] : line["poses"].items()) {
      question.poses.push_back({name, pose_of(pose)});
    }
  }
  if (line.contains("others")) question.others = others_of(line["others"].get<std::string>());
  if (line.contains("margins")) question.margins = line["margins"].get<std::vector<double>>();
  return question;
}

OrderedJson answer_line(const Answer& answer, const Scene& scene) {
  OrderedJson line;
  line["lower"] = answer.lower;
  line["upper"] = nullptr;
  if (answer.has_pair && answer.upper < kInfinity) {
    line["upper"] = answer.upper;
    line["t"] = answer.time;
    line["pair"] = names_of(scene, answer.first, answer.second);
    if (answer.upper > 0.0) {
      const Vec3 &a = answer.point_on_first, &b = answer.point_on_second;
      line["points"] = {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
    }
  }
  line["first_below"] = OrderedJson::object();
  line["verdict"] = OrderedJson::object();
  for (const MarginAnswer& margin : answer.margins) {
    const std::string key = fmt::format("{:g}", margin.margin);
    line["first_below"][key] = first_below(margin, scene);
    line["verdict"][key] = name(margin.verdict);
  }
  line["queries"] = answer.queries;
  line["within_work_limit"] = answer.within_work_limit;
  return line;
}

}  // namespace clearance
