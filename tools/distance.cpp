// clearance-distance: the distances of the pairs in a file of cases, one JSON object a line in and
// out.
//
// It is how anyone checks the core against anything: every figure the core gives is in the answer,
// and doubles are printed so that they read back as the same doubles.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "core/active_side.hpp"
#include "core/distance.hpp"
#include "core/dqp3.hpp"
#include "core/pose.hpp"
#include "core/precision.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr const char* kDescription =
    R"(Minimum distances of pairs of convex bodies, with certified bounds.

Reads one case a line and writes one answer a line, in the same order. A case is a JSON object:
  id           a name, repeated in the answer
  a, b         the bodies: {"halfspaces": [[nx, ny, nz, d], ...]} is the set of all x with n.x <= d in every
               row, in the body's own frame; n need not have unit length and the set may be unbounded.
               Without half-spaces {"vertices": [[x, y, z], ...]} is the hull of the points (one: a point,
               two: a segment). "radius": r adds a ball (a point becomes a sphere). Metres.
  pose_a, pose_b   [x, y, z, qw, qx, qy, qz]: a point p of the body is at (x, y, z) + R p in the world
  poses        instead of these: [[pose_a, pose_b], ...], a motion; each query starts where the last ended
An answer has id; distance, lower, upper (0 where the bodies overlap); witness_a, witness_b: closest points, where
the bodies overlap a point of both; penetration, penetration_lower, penetration_upper: the length of the shortest
translation that parts them (0 where they are apart); normal: its direction for b, as that from a to b otherwise;
deepest_a, deepest_b: the points that meet when b has been moved by it; status, iterations. All in the world; for a
motion each is a list with one entry a pose. Numbers read back as the same doubles; null is "unknown".
A line that cannot be answered gets {"line": n, "error": "..."} and the rest goes on.)";

constexpr const char* kExample =
    R"(Exit status: 0 every line answered, 1 some lines have errors, 2 wrong usage or unreadable files.

Example: two unit cubes, faces 0.5 m apart
  echo '{"id": "cubes",
         "a": {"halfspaces": [[1,0,0,0.5],[-1,0,0,0.5],[0,1,0,0.5],[0,-1,0,0.5],[0,0,1,0.5],[0,0,-1,0.5]]},
         "b": {"halfspaces": [[1,0,0,0.5],[-1,0,0,0.5],[0,1,0,0.5],[0,-1,0,0.5],[0,0,1,0.5],[0,0,-1,0.5]]},
         "pose_a": [0,0,0,1,0,0,0], "pose_b": [1.5,0,0,1,0,0,0]}' | tr -d '\n' |
    clearance-distance --cases - --out -)";

// What is wrong with a line, said so that its writer can mend it.
struct BadLine : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// As much of a value as a message can carry.
std::string shown(const Json& value) {
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= 80 ? text : text.substr(0, 77) + "...";
}

const Json& member(const Json& object, const char* key, const std::string& where) {
  if (!object.is_object()) throw BadLine(where + " is not a JSON object");
  const auto found = object.find(key);
  if (found == object.end()) throw BadLine(where + " has no \"" + key + "\"");
  return *found;
}

template <std::size_t N>
std::array<double, N> numbers(const Json& list, const std::string& where, const char* expected) {
  if (!list.is_array() || list.size() != N) {
    throw BadLine(where + ": expected " + expected + ", found " + shown(list));
  }
  std::array<double, N> out{};
  for (std::size_t k = 0; k < N; ++k) {
    if (!list[k].is_number()) throw BadLine(where + ": " + shown(list[k]) + " is not a number");
    out[k] = list[k].get<double>();
  }
  return out;
}

// As far as the core's shapes may reach: squares of such lengths are far from overflowing.
constexpr double kFarthest = 1e100;  // m

Pose read_pose(const Json& list, const std::string& where) {
  const auto v = numbers<7>(list, where, "[x, y, z, qw, qx, qy, qz]");
  const Pose pose{{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
  const double norm = pose.orientation.norm();
  if (!pose.position.allFinite() || !std::isfinite(norm)) {
    throw BadLine(where + " is not finite");
  }
  if (!(pose.position.cwiseAbs().maxCoeff() <= kFarthest)) {
    throw BadLine(where + " lies more than 1e100 m from the origin");
  }
  if (norm == 0.0) throw BadLine(where + ": the quaternion has length zero");
  return pose;
}

ShapeResult shape_of_rows(const Json& list, const std::string& where) {
  std::vector<HalfSpace> rows;
  for (const Json& entry : list) {
    const std::string row = where + ".halfspaces[" + std::to_string(rows.size()) + "]";
    const auto v = numbers<4>(entry, row, "[nx, ny, nz, d]");
    rows.push_back({{v[0], v[1], v[2]}, v[3]});
  }
  return polyhedron_from_halfspaces(rows);
}

ShapeResult shape_of_vertices(const Json& list, const std::string& where, double radius) {
  std::vector<Vec3> points;
  for (const Json& entry : list) {
    const std::string row = where + ".vertices[" + std::to_string(points.size()) + "]";
    const auto v = numbers<3>(entry, row, "[x, y, z]");
    points.emplace_back(v[0], v[1], v[2]);
  }
  if (points.size() == 1) return point(points[0], radius);
  if (points.size() == 2) return segment(points[0], points[1], radius);
  return polyhedron_from_vertices(points);
}

ConvexPolyhedron read_body(const Json& body, const std::string& where) {
  if (!body.is_object()) throw BadLine(where + " is not a JSON object");
  double radius = 0.0;
  if (const auto found = body.find("radius"); found != body.end() && !found->is_null()) {
    if (!found->is_number() || !(found->get<double>() >= 0.0) ||
        !(found->get<double>() <= kFarthest)) {
      throw BadLine(where + ".radius: expected a length in metres, at most 1e100, found " +
                    shown(*found));
    }
    radius = found->get<double>();
  }
  const auto list_named = [&](const char* key) -> const Json* {
    const auto found = body.find(key);
    if (found == body.end() || found->is_null()) return nullptr;
    if (!found->is_array()) throw BadLine(where + "." + key + " is not a list");
    return &*found;
  };
  const Json* rows = list_named("halfspaces");
  const Json* vertices = list_named("vertices");
  if (rows == nullptr && vertices == nullptr) {
    throw BadLine(where + " has neither \"halfspaces\" nor \"vertices\"");
  }
  ShapeResult shape =
      rows != nullptr ? shape_of_rows(*rows, where) : shape_of_vertices(*vertices, where, radius);
  if (const auto* error = std::get_if<ShapeError>(&shape)) {
    throw BadLine(where + ": " + error->reason);
  }
  ConvexPolyhedron& polyhedron = std::get<ConvexPolyhedron>(shape);
  polyhedron.radius = radius;
  return std::move(polyhedron);
}

OrderedJson world_point(const Pose& world_from_a, const Vec3& point_in_a) {
  const Vec3 p = transform(world_from_a, point_in_a);
  return OrderedJson::array({p.x(), p.y(), p.z()});
}

// Of two bodies that overlap, in frame A: where a search for the closest points ends.
Vec3 shared_point(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                  const RelativePose& a_from_b) {
  ActiveSide side_a(a, nullptr), side_b(b, &a_from_b);
  side_a.place_cold(side_b.point_to_common(b.interior));
  side_b.place_cold(a.interior);
  (void)dqp3(side_a, side_b, precision(a, b, a_from_b, 0.0).tight);
  const double radii = a.radius + b.radius;
  const double part_of_a = radii > 0.0 ? a.radius / radii : 0.5;
  return side_a.common() + part_of_a * (side_b.common() - side_a.common());
}

struct Options {
  std::string cases, out;
  bool cold = false;
  int repeat = 1;
};

class Answerer {
 public:
  explicit Answerer(const Options& options) : options_(options) {}

  // Throws BadLine, or nlohmann's own errors where the line is not JSON.
  OrderedJson answer(const std::string& line) {
    const Json question = Json::parse(line);
    const Json& id = member(question, "id", "the case");
    const ConvexPolyhedron a = read_body(member(question, "a", "the case"), "a");
    const ConvexPolyhedron b = read_body(member(question, "b", "the case"), "b");
    OrderedJson out;
    out["id"] = id;
    if (!question.contains("poses")) {
      const Pose pose_a = read_pose(member(question, "pose_a", "the case"), "pose_a");
      const Pose pose_b = read_pose(member(question, "pose_b", "the case"), "pose_b");
      const std::vector<DistanceResult> results = run(a, b, {{pose_a, pose_b}});
      out.update(figures(a, b, pose_a, pose_b, results[0]));
      return out;
    }
    const std::vector<std::pair<Pose, Pose>> poses = read_motion(question["poses"]);
    const std::vector<DistanceResult> results = run(a, b, poses);
    for (const char* key : {"distance", "lower", "upper", "witness_a", "witness_b", "penetration",
                            "penetration_lower", "penetration_upper", "normal", "deepest_a",
                            "deepest_b", "status", "iterations"}) {
      out[key] = OrderedJson::array();
    }
    for (std::size_t k = 0; k < results.size(); ++k) {
      const OrderedJson step = figures(a, b, poses[k].first, poses[k].second, results[k]);
      for (const auto& [key, value] : step.items()) out[key].push_back(value);
    }
    return out;
  }

  void print_summary(std::size_t lines, std::size_t bad_lines) const {
    std::cerr << "clearance-distance: " << lines << " lines, " << bad_lines << " with errors, "
              << queries_ << " queries" << (options_.cold ? " (cold)" : "");
    if (queries_ > 0) {
      const double ns = std::chrono::duration<double, std::nano>(time_).count();
      std::cerr << ", " << std::llround(ns / static_cast<double>(queries_)) << " ns a query, "
                << not_converged_ << " stopped at the iteration limit";
    }
    std::cerr << '\n';
  }

 private:
  static std::vector<std::pair<Pose, Pose>> read_motion(const Json& list) {
    if (!list.is_array()) throw BadLine("poses is not a list");
    std::vector<std::pair<Pose, Pose>> out;
    for (const Json& step : list) {
      const std::string where = "poses[" + std::to_string(out.size()) + "]";
      if (!step.is_array() || step.size() != 2) {
        throw BadLine(where + ": expected [pose_a, pose_b], found " + shown(step));
      }
      out.emplace_back(read_pose(step[0], where + "[0]"), read_pose(step[1], where + "[1]"));
    }
    return out;
  }

  // One pass over the motion gives the answers; further ones are only for the clock.
  std::vector<DistanceResult> run(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                  const std::vector<std::pair<Pose, Pose>>& poses) {
    std::vector<DistanceResult> results(poses.size());
    for (int pass = 0; pass < options_.repeat; ++pass) {
      TrackingState state;
      const Clock::time_point start = Clock::now();
      for (std::size_t k = 0; k < poses.size(); ++k) {
        if (options_.cold) state = {};
        results[k] = distance(a, b, relative_pose(poses[k].first, poses[k].second), state);
      }
      time_ += Clock::now() - start;
      queries_ += poses.size();
    }
    for (const DistanceResult& r : results) {
      not_converged_ += r.status == DistanceStatus::kIterationLimit ? 1 : 0;
    }
    return results;
  }

  static OrderedJson figures(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                             const Pose& world_from_a, const Pose& world_from_b,
                             const DistanceResult& r) {
    const bool overlapping = r.upper < 0.0;
    const Vec3 shared =
        overlapping ? shared_point(a, b, relative_pose(world_from_a, world_from_b)) : Vec3::Zero();
    const auto positive = [](double value) { return std::max(0.0, value); };
    OrderedJson out;
    out["distance"] = overlapping ? 0.0 : positive(r.distance);
    out["lower"] = positive(r.lower);
    out["upper"] = positive(r.upper);
    out["witness_a"] = world_point(world_from_a, overlapping ? shared : r.point_on_a);
    out["witness_b"] = world_point(world_from_a, overlapping ? shared : r.point_on_b);
    out["penetration"] = r.lower > 0.0            ? 0.0
                         : std::isnan(r.distance) ? r.distance
                                                  : positive(-r.distance);
    out["penetration_lower"] = positive(-r.upper);
    out["penetration_upper"] = positive(-r.lower);
    const Vec3 normal = transform({Vec3::Zero(), world_from_a.orientation}, r.normal);
    out["normal"] = OrderedJson::array({normal.x(), normal.y(), normal.z()});
    out["deepest_a"] = world_point(world_from_a, r.point_on_a);
    out["deepest_b"] = world_point(world_from_a, r.point_on_b);
    out["status"] = name(r.status);
    out["iterations"] = r.iterations;
    return out;
  }

  const Options& options_;
  std::size_t queries_ = 0;
  std::size_t not_converged_ = 0;
  Clock::duration time_{};
};

int answer_all(const Options& options, std::istream& in, std::ostream& out) {
  Answerer answerer(options);
  std::size_t line_number = 0, asked = 0, bad = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    ++asked;
    OrderedJson answer;
    try {
      answer = answerer.answer(line);
    } catch (const BadLine& error) {
      answer = {{"line", line_number}, {"error", error.what()}};
    } catch (const nlohmann::json::exception& error) {
      answer = {{"line", line_number}, {"error", std::string("not JSON: ") + error.what()}};
    }
    bad += answer.contains("error") ? 1 : 0;
    out << answer.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) << '\n';
  }
  out.flush();
  answerer.print_summary(asked, bad);
  if (in.bad()) {
    std::cerr << "clearance-distance: cannot read " << options.cases << '\n';
    return 2;
  }
  if (!out) {
    std::cerr << "clearance-distance: could not write all answers to " << options.out << '\n';
    return 2;
  }
  return bad == 0 ? 0 : 1;
}

int run(const Options& options) {
  std::error_code not_there;
  if (std::filesystem::equivalent(options.cases, options.out, not_there)) {
    std::cerr << "clearance-distance: " << options.out
              << " is the file of cases itself; give another one for the answers\n";
    return 2;
  }
  std::ifstream file_in;
  std::ofstream file_out;
  if (options.cases != "-") {
    file_in.open(options.cases);
    if (!file_in) {
      std::cerr << "clearance-distance: cannot read " << options.cases << '\n';
      return 2;
    }
  }
  if (options.out != "-") {
    file_out.open(options.out);
    if (!file_out) {
      std::cerr << "clearance-distance: cannot write " << options.out << '\n';
      return 2;
    }
  }
  return answer_all(options, options.cases == "-" ? std::cin : file_in,
                    options.out == "-" ? std::cout : file_out);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  CLI::App app(clearance::kDescription, "clearance-distance");
  app.footer(clearance::kExample);
  clearance::Options options;
  app.add_option("--cases", options.cases, "File of cases, one a line; - is standard input")
      ->required();
  app.add_option("--out", options.out, "File for the answers; - is standard output")->required();
  app.add_flag("--cold", options.cold, "Forget the state between the poses of a motion");
  app.add_option("--repeat", options.repeat, "Ask everything N times, for the time on stderr")
      ->check(CLI::Range(1, 1000000));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return clearance::run(options);
}
