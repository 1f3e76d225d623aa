// clearance-distance: the distances of the pairs in a file of cases, one JSON object a line in and
// out.
//
// The program serves to check the core against other programs. The answer has every figure of the
// core, and doubles are printed so that they read back as the same doubles.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/files/file_error.hpp"
#include "tools/distance/answerer.hpp"
#include "tools/distance/curved_answerer.hpp"
#include "tools/distance/exact_check.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kDescription =
    R"(Minimum distances of pairs of convex bodies, with certified bounds.

Reads one case a line and writes one answer a line, in the same order. A case is a JSON object:
  id           a name, repeated in the answer
  a, b         the bodies: {"halfspaces": [[nx, ny, nz, d], ...]} is the set of all x with n.x <= d in every
               row, in the body's own frame; n need not have unit length and the set may be unbounded.
               Without half-spaces {"vertices": [[x, y, z], ...]} is the hull of the points (one: a point,
               two: a segment). "radius": r adds a swept sphere (a point becomes a sphere). Metres.
               Curved: {"ellipsoid": [rx, ry, rz]}, around the z-axis {"cylinder": {"radius": r, "half_length": h}},
               {"cone": {"radius": r, "half_length": h}} with the apex at z = h, {"truncated_cone": {"lower_radius",
               "upper_radius", "half_length"}}, each with a "radius" beside it if wanted. Several bodies in one frame:
               {"parts": [{"pose": {"xyz": ..., "quaternion": ...}, ...}, ...]}. --check leaves these lines out.
  pose_a, pose_b   {"xyz": [x, y, z], "quaternion": [x, y, z, w]}, as in a cell, one of them or both: a point p of
               the body is at (x, y, z) + R p in the world
  poses        instead of these: [[pose_a, pose_b], ...], a motion; each query starts where the last ended
An answer has id; distance, lower, upper (0 where the bodies overlap); witness_a, witness_b: closest points, where
the bodies overlap a point of both; penetration, penetration_lower, penetration_upper: the length of the shortest
translation that separates them (0 where they are apart); normal: its direction for b, as that from a to b otherwise;
deepest_a, deepest_b: the points that meet when b has been moved by it; status, iterations. All in the world; for a
motion each is a list with one entry a pose. Numbers read back as the same doubles; null is "unknown", and where no
translation separates two unbounded bodies: penetration and its bounds are null then, the normal is [0, 0, 0].
A line that cannot be answered gets {"line": n, "error": "..."}, and the other lines are answered; the first such
line is reported on stderr as well.)";

constexpr const char* kExample =
    R"(With --check, cases carry exact answers: "distance" as text ("distances": a list of them, for a motion), and if
known "penetration" and "scale", the length to which errors are relative. Distances, depths and witness points
have to be right within --tolerance, bounds to hold exactly and to be no farther apart than --gap says. Every fault
and a table by "family" go to stderr.

Exit status: 0 every line answered (and right), 1 some lines have errors or wrong answers, 2 wrong usage or
unreadable files.

Example: two unit cubes, faces 0.5 m apart
  echo '{"id": "cubes",
         "a": {"halfspaces": [[1,0,0,0.5],[-1,0,0,0.5],[0,1,0,0.5],[0,-1,0,0.5],[0,0,1,0.5],[0,0,-1,0.5]]},
         "b": {"halfspaces": [[1,0,0,0.5],[-1,0,0,0.5],[0,1,0,0.5],[0,-1,0,0.5],[0,0,1,0.5],[0,0,-1,0.5]]},
         "pose_a": {"xyz": [0,0,0]}, "pose_b": {"xyz": [1.5,0,0]}}' | tr -d '\n' |
    clearance-distance --cases - --out -)";

struct Options {
  std::string cases, out;
  bool cold = false;
  int repeat = 1;
  bool check = false;
  double tolerance = 1e-14, gap = 1.25e-14;
};

void tell(const Options& options, std::size_t line, const std::vector<std::string>& faults) {
  for (const std::string& fault : faults) {
    print(stderr, "{}:{}: {}\n", options.cases, line, fault);
  }
}

int answer_all(const Options& options, std::istream& in, std::ostream& out) {
  Answerer answerer(options.cold, options.repeat);
  CurvedAnswerer curved(options.cold, options.repeat);
  ExactCheck check(options.tolerance, options.gap);
  std::size_t line_number = 0, lines = 0, bad = 0;
  for (std::string line; std::getline(in, line);) {
    ++line_number;
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    ++lines;
    OrderedJson answer;
    try {
      const nlohmann::json question = parse_line(line);
      if (is_curved_case(question)) {
        answer = curved.answer(read_curved_case(question));
      } else {
        const DistanceCase asked = read_case(question);
        answer = answerer.answer(asked);
        if (options.check) tell(options, line_number, check.faults(question, asked, answer));
      }
    } catch (const BadLine& error) {
      answer = {{"line", line_number}, {"error", error.what()}};
    } catch (const nlohmann::json::exception& error) {
      answer = {{"line", line_number}, {"error", std::string("not JSON: ") + error.what()}};
    }
    const bool is_bad = answer.contains("error");
    if (is_bad && bad == 0) tell(options, line_number, {answer["error"].get<std::string>()});
    bad += is_bad ? 1 : 0;
    out << answer.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) << '\n';
  }
  out.flush();
  answerer.print_summary(lines, bad);
  curved.print_summary();
  if (options.check) check.print_summary();
  if (in.bad()) {
    print(stderr, "clearance-distance: cannot read {}\n", options.cases);
    return kUsage;
  }
  if (lines == 0) {
    print(stderr, "clearance-distance: {} holds no case; expected a JSON object a line\n",
          options.cases);
    return kUsage;
  }
  if (!out) {
    print(stderr, "clearance-distance: could not write all answers to {}\n", options.out);
    return kUsage;
  }
  return bad == 0 && (!options.check || check.good()) ? kOk : kFailed;
}

int run(const Options& options) {
  if (!output_is_not_an_input("clearance-distance", options.out, {options.cases})) return kUsage;
  std::ifstream file_in;
  std::ofstream file_out;
  if (options.cases != "-") {
    file_in.open(options.cases);
    if (!file_in || std::filesystem::is_directory(options.cases)) {
      print(stderr, "clearance-distance: {}\n", cannot_read(options.cases));
      return kUsage;
    }
  }
  if (options.out != "-") {
    file_out.open(options.out);
    if (!file_out) {
      print(stderr, "clearance-distance: {}\n", cannot_write(options.out));
      return kUsage;
    }
  }
  return answer_all(options, options.cases == "-" ? std::cin : file_in,
                    options.out == "-" ? std::cout : file_out);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  clearance::Options options;
  clearance::CommandLine line{clearance::kDescription, clearance::kExample};
  line.options = {
      {"--cases", &options.cases, "File of cases, one a line; - is standard input",
       clearance::required()},
      {"--out", &options.out, "File for the answers; - is standard output", clearance::required()},
      {"--cold", &options.cold, "Reset the tracking state between the poses of a motion"},
      {"--repeat", &options.repeat, "Repeat every query N times, for the time on stderr",
       clearance::whole_number_in(1, 1'000'000)},
      {"--check", &options.check, "Check the answers against exact ones in the cases"},
      {"--tolerance",
       &options.tolerance,
       "Largest error that --check accepts, relative to the larger of a case's scale and distance",
       clearance::number_from_zero(),
       {.shows_default = true, .needs = {"--check"}}},
      {"--gap",
       &options.gap,
       "Largest gap between bounds that --check accepts, relative to the sum of both bodies' "
       "bounding radii and the distance of their origins",
       clearance::number_from_zero(),
       {.shows_default = true, .needs = {"--check"}}},
  };
  if (const auto done = clearance::parse(line, argc, argv)) return *done;
  return clearance::run(options);
}
