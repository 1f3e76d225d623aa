#include "tools/ask/motion_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/ask/asker.hpp"
#include "tools/cases/case.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;

// The keys of a trajectory.
const std::vector<std::string> kTrajectoryKeys = {"joints", "times_s", "positions", "velocities"};

// A motion has those, and these. The last ones describe it to people and say what is true of it.
std::vector<std::string> keys_of_a_motion() {
  std::vector<std::string> keys = kTrajectoryKeys;
  for (const char* key : {"id",           "scene",       "held",        "joints_of_others",
                          "poses",        "turn_speeds", "margins",     "beside",
                          "moving",       "payloads",    "contacts",    "profile",
                          "time_scaling", "stoppable",   "others",      "kind",
                          "how",          "what",        "nominal",     "recording",
                          "robot",        "least",       "first_below", "evals",
                          "gap"})
    keys.emplace_back(key);
  return keys;
}

// Calls use(value) for the value of a key, if it is there. A value of a wrong type names the key.
template <class Use>
void read_key(const Json& object, const char* key, const Use& use) {
  const auto at = object.find(key);
  if (at == object.end()) return;
  try {
    use(*at);
  } catch (const Json::exception& error) {
    const std::string text = error.what();  // "[json.exception.type_error.302] type must be ..."
    throw BadLine(fmt::format("\"{}\": {}", key, text.substr(text.find("] ") + 2)));
  }
}

template <class T, std::size_t N>
std::array<T, N> entries(const Json& list, const std::string& where, const char* expected) {
  expect_list(list, N, where, expected);
  return list.get<std::array<T, N>>();
}

std::vector<double> rows_of(const Json& line, const char* key, std::size_t columns) {
  std::vector<double> numbers;
  for (const Json& row : line.at(key)) {
    if (row.size() != columns) {
      throw BadLine(fmt::format("a row of \"{}\" has {} numbers; expected {}, one for each joint",
                                key, row.size(), columns));
    }
    for (const Json& number : row) numbers.push_back(number.get<double>());
  }
  return numbers;
}

JointTrajectory trajectory_of(const Json& line) {
  for (const char* key : {"joints", "times_s", "positions"}) (void)member(line, key, "a motion");
  JointTrajectory motion;
  read_key(line, "joints", [&](const Json& of) { of.get_to(motion.joints); });
  read_key(line, "times_s", [&](const Json& of) { of.get_to(motion.times); });
  const std::size_t columns = motion.joints.size();
  read_key(line, "positions",
           [&](const Json&) { motion.positions = rows_of(line, "positions", columns); });
  read_key(line, "velocities",
           [&](const Json&) { motion.velocities = rows_of(line, "velocities", columns); });
  return motion;
}

ObjectMotion object_motion_of(const std::string& object, const Json& entry) {
  refuse_unknown_keys(entry, {"times_s", "poses"}, "a motion of an object");
  ObjectMotion motion{.object = object,
                      .times = entry.at("times_s").get<std::vector<double>>(),
                      .world_from_object = {}};
  for (const Json& pose : entry.at("poses")) {
    motion.world_from_object.push_back(read_pose(
        pose, fmt::format("moving.{}.poses[{}]", object, motion.world_from_object.size())));
  }
  return motion;
}

std::optional<ConvexBody> shape_of(const Json& entry) {
  if (entry.count("box") + entry.count("sphere") + entry.count("cylinder") +
          entry.count("vertices") >
      1) {
    throw BadLine("a payload has several shapes; expected one of them");
  }
  ShapeResult made = ShapeError{};
  if (entry.contains("box")) {
    const auto size = entries<double, 3>(entry["box"], "the box of a payload", "[x, y, z]");
    made = box({0.5 * size[0], 0.5 * size[1], 0.5 * size[2]});
  } else if (entry.contains("sphere")) {
    made = point(Vec3::Zero(), entry["sphere"].get<double>());
  } else if (entry.contains("cylinder")) {
    const auto size =
        entries<double, 2>(entry["cylinder"], "the cylinder of a payload", "[radius, length]");
    made = cylinder(size[0], 0.5 * size[1]);
  } else if (entry.contains("vertices")) {
    std::vector<Vec3> vertices;
    for (const Json& vertex : entry["vertices"]) {
      const auto v = entries<double, 3>(vertex, "a vertex of a payload", "[x, y, z]");
      vertices.push_back({v[0], v[1], v[2]});
    }
    made = polyhedron_from_vertices(vertices);
  } else {
    return std::nullopt;
  }
  if (const auto* error = std::get_if<ShapeError>(&made)) {
    throw BadLine("the shape of a payload: " + error->reason);
  }
  return std::get<ConvexBody>(std::move(made));
}

Payload payload_of(const Json& entry) {
  refuse_unknown_keys(entry,
                      {"name", "link", "pose", "touch", "box", "sphere", "cylinder", "vertices"},
                      "a payload");
  Payload payload;
  payload.name = entry.at("name").get<std::string>();
  payload.link = entry.at("link").get<std::string>();
  payload.shape = shape_of(entry);
  if (entry.contains("pose"))
    payload.link_from_object = read_pose(entry["pose"], "the pose of a payload");
  if (entry.contains("touch")) payload.touch = entry["touch"].get<std::vector<std::string>>();
  return payload;
}

MeantContact contact_of(const Json& entry) {
  refuse_unknown_keys(entry, {"pair", "depth", "until", "distance"}, "a contact");
  const auto pair =
      entries<std::string, 2>(entry.at("pair"), "the pair of a contact", R"(["a", "b"])");
  return {.first = pair[0],
          .second = pair[1],
          .depth = entry.at("depth").get<double>(),
          .until = entry.value("until", kInfinity),
          .distance = entry.value("distance", kInfinity)};
}

std::optional<ProfileRequest> profile_of(const Json& entry) {
  if (entry.is_boolean()) {
    return entry.get<bool>() ? std::optional(ProfileRequest()) : std::nullopt;
  }
  refuse_unknown_keys(entry, {"pair", "tolerance", "points"}, "a profile");
  ProfileRequest profile;
  if (entry.contains("pair")) {
    const auto pair =
        entries<std::string, 2>(entry["pair"], "the pair of a profile", R"(["a", "b"])");
    profile.first = pair[0];
    profile.second = pair[1];
  }
  profile.tolerance = entry.value("tolerance", profile.tolerance);
  profile.most_points = entry.value("points", profile.most_points);
  return profile;
}

OthersMove others_of(const std::string& text) {
  if (text == "max_speed") return OthersMove::kWithinMaxSpeed;
  if (text == "still") return OthersMove::kNot;
  throw BadLine("\"others\" is \"" + text + "\"; expected \"max_speed\" or \"still\"");
}

// The names of objects in an answer.
struct Names {
  const Scene& scene;
  const Question& question;

  [[nodiscard]] OrderedJson of(std::uint32_t first, std::uint32_t second) const {
    return {object_name(scene, question, first), object_name(scene, question, second)};
  }
};

OrderedJson first_below(const MarginAnswer& margin, const Names& names) {
  if (margin.verdict == Verdict::kFree) return nullptr;
  OrderedJson entry;
  if (margin.verdict == Verdict::kBelow) {
    entry["t"] = {margin.above_until, margin.below_at};
  } else {
    entry["t"] = "undecided";
    entry["above_until"] = margin.above_until;
  }
  entry["pair"] = names.of(margin.first, margin.second);
  return entry;
}

// Factors without limit are null.
OrderedJson scaling_of(const TimeScaling& scaling, const Names& names) {
  OrderedJson entry;
  const auto limited = [](double factor) -> OrderedJson {
    if (factor == kInfinity) return nullptr;
    return factor;
  };
  entry["factor"] = limited(scaling.factor);
  entry["factor_above"] = limited(scaling.factor_above);
  if (scaling.factor_above < kInfinity) {
    entry["t"] = scaling.time;
    entry["pair"] = names.of(scaling.first, scaling.second);
    entry["zone"] = nullptr;
    if (scaling.zone != TimeScaling::kNoZone) entry["zone"] = names.scene.zones[scaling.zone].name;
  }
  return entry;
}

// A margin is a number for all pairs, or a map for some.
void read_margins(const Json& margins, Question& question) {
  question.margins.clear();
  question.margins_between.clear();
  for (const Json& margin : margins) {
    if (margin.is_number()) {
      question.margins.push_back(margin.get<double>());
      continue;
    }
    if (!margin.is_object())
      throw BadLine(
          fmt::format("found the margin {}; expected a number or an object", margin.dump()));
    const bool is_of_zone = margin.contains("zone");
    refuse_unknown_keys(margin, {is_of_zone ? "zone" : "between", "m"}, "a margin");
    MarginBetween& of = question.margins_between.emplace_back();
    of.margin = margin.at("m").get<double>();
    if (is_of_zone) {
      of.a = margin["zone"].get<std::string>();
    } else {
      const auto sides =
          entries<std::string, 2>(margin.at("between"), "\"between\" of a margin", R"(["a", "b"])");
      of.a = sides[0];
      of.b = sides[1];
    }
  }
}

}  // namespace

std::string margin_text(const Question& question, std::size_t place) {
  if (place < question.margins.size()) return fmt::format("{:g}", question.margins[place]);
  const MarginBetween& of = question.margins_between[place - question.margins.size()];
  return fmt::format("{}{}{}={:g}", of.a, of.b.empty() ? "" : ",", of.b, of.margin);
}

Question read_question(const Json& line, const Question& defaults) {
  static const std::vector<std::string> kKeys = keys_of_a_motion();
  refuse_unknown_keys(line, kKeys, "the motion");
  Question question = defaults;
  question.motion = trajectory_of(line);
  const auto read = [&line](const char* key, const auto& use) { read_key(line, key, use); };
  read("held", [&](const Json& of) {
    if (!of.is_object()) throw BadLine(R"("held" is no object; expected {"JOINT": position})");
    for (const auto& [name, position] : of.items()) {
      question.held.push_back({name, position.get<double>()});
    }
  });
  read("poses", [&](const Json& of) {
    for (const auto& [name, pose] : of.items()) {
      question.poses.push_back({name, read_pose(pose, "poses." + name)});
    }
  });
  read("joints_of_others", [&](const Json& of) {
    for (const auto& [name, stated] : of.items()) {
      StatedJoint joint{.name = name};
      if (stated.is_array()) {
        const auto [position, age] =
            entries<double, 2>(stated, "joints_of_others." + name, "[position, age]");
        joint.position = position;
        joint.age = age;
      } else {
        joint.position = stated.get<double>();
      }
      question.joints.push_back(joint);
    }
  });
  read("turn_speeds", [&](const Json& of) {
    for (const auto& [name, speed] : of.items()) {
      const auto at = std::ranges::find(question.poses, name, &StatedPose::object);
      if (at == question.poses.end())
        throw BadLine("\"turn_speeds\" names \"" + name + "\", which has no pose");
      at->turn_speed = speed.get<double>();
    }
  });
  read("beside", [&](const Json& of) {
    for (const Json& motion : of) {
      refuse_unknown_keys(motion, kTrajectoryKeys, "a motion beside");
      question.beside.push_back(trajectory_of(motion));
    }
  });
  read("moving", [&](const Json& of) {
    for (const auto& [name, motion] : of.items()) {
      question.moving.push_back(object_motion_of(name, motion));
    }
  });
  read("payloads", [&](const Json& of) {
    for (const Json& payload : of) question.payloads.push_back(payload_of(payload));
  });
  read("contacts", [&](const Json& of) {
    question.contacts.emplace();
    for (const Json& contact : of) question.contacts->push_back(contact_of(contact));
  });
  read("profile", [&](const Json& of) { question.profile = profile_of(of); });
  read("time_scaling", [&](const Json& of) { question.time_scaling = of.get<bool>(); });
  read("stoppable", [&](const Json& of) { question.stoppable = of.get<bool>(); });
  read("others", [&](const Json& of) { question.others = others_of(of.get<std::string>()); });
  read("margins", [&](const Json& of) { read_margins(of, question); });
  return question;
}

OrderedJson answer_line(const Answer& answer, const Scene& scene, const Question& question) {
  const Names names{scene, question};
  OrderedJson line;
  if (const auto without = sensors_left_out(question); !without.empty()) line["without"] = without;
  line["lower"] = answer.lower;
  line["upper"] = nullptr;
  if (answer.has_pair && answer.upper < kInfinity) {
    line["upper"] = answer.upper;
    line["t"] = answer.time;
    line["pair"] = names.of(answer.first, answer.second);
    if (answer.upper > 0.0) {
      const Vec3 &a = answer.point_on_first, &b = answer.point_on_second;
      line["points"] = {{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}};
    }
  }
  line["first_below"] = OrderedJson::object();
  line["verdict"] = OrderedJson::object();
  for (std::size_t i = 0; i < answer.margins.size(); ++i) {
    const MarginAnswer& margin = answer.margins[i];
    const std::string key = margin_text(question, i);
    line["first_below"][key] = first_below(margin, names);
    line["verdict"][key] = name(margin.verdict);
  }
  if (question.profile) {
    line["profile"] = OrderedJson::array();
    for (const ProfilePoint& point : answer.profile) {
      line["profile"].push_back({{"t", {point.from, point.to}},
                                 {"lower", point.lower},
                                 {"upper", point.upper},
                                 {"pair", names.of(point.first, point.second)}});
    }
  }
  if (question.time_scaling) line["time_scaling"] = scaling_of(answer.scaling, names);
  line["queries"] = answer.queries;
  line["within_work_limit"] = answer.within_work_limit;
  return line;
}

}  // namespace clearance
