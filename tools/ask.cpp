// clearance-ask: certified distances of whole motions, one JSON object a line in and out.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/files/file_error.hpp"
#include "monitor/recording/bag.hpp"
#include "tools/ask/answering.hpp"

namespace clearance {
namespace {

constexpr const char* kDescription =
    R"(Says of a motion before it is made how near it comes to anything: at all instants, not at samples.

MOTIONS may be a bag of ROS 2: then each trajectory_msgs/JointTrajectory is a motion. All other joints, objects, frames
of sensors and MoveIt's scene are those that a replay of the bag has at that time, judged as the daemon judges them.
Otherwise MOTIONS has one motion a line, below.

CELL is a cell file. If it is a folder, the key "scene" of each motion names a cell in it: SCENE.yaml.
A motion is a JSON object:
  id          a name, repeated in the answer
  joints      names of joints of the cell
  times_s     of the waypoints, s, increasing
  positions   a row a waypoint, a number a joint; rad or m. Between waypoints joints move linearly in time,
  velocities  or with rows of these along cubic polynomials, as trajectory_msgs/JointTrajectory says
  held        {"JOINT": position} of joints that stay; joints that mimic others follow
  joints_of_others  {"JOINT": position, or [position, age in s]} of robots that do nothing here: they stay within
              their velocity limits x time, and within their limits; with "others": "still" where they are
  poses       {"OBJECT": {"xyz": [x, y, z], "quaternion": [x, y, z, w]}} of objects that are neither fixed nor part
              of a robot; one of the two may be left out, as in a cell. Such an object comes nearer by its max_speed x time, or with "others": "still" not at all
  turn_speeds {"OBJECT": rad/s} of such objects on which robots stand; without it they may rotate by any angle
  margins     m, instead of --margin; or {"between": ["A", "B"], "m": 0.05}, {"zone": "Z", "m": 0.05} for some pairs
  beside      [{joints, times_s, positions, velocities}] of other robots, which rest before and after
  moving      {"OBJECT": {"times_s": [...], "poses": [POSE, ...]}}: stated motions of objects
  payloads    [{"name", "link", "pose", "touch": [...]}]: what links carry, an object of the cell or a new one with
              "box": [x, y, z], "sphere": radius, "cylinder": [radius, length] or "vertices": [[x, y, z], ...]
  contacts    [{"pair": ["A", "B"], "depth": m, "until": s, "distance": m}]: contacts that are meant, down to this depth,
              up to this time and until the two may be this far apart; without it those of the cell that no clock ends
  profile     true, or {"pair": ["A", "B"], "tolerance": m, "points": N}: the distance over time
  time_scaling  true: the largest factor by which the motion may be timed faster so that S_p of zones holds
  stoppable   true: bounds and margins count stops that begin at any instant of the motion, too, as the cell states
              stopping for its robots; time_scaling keeps the margins as well, and tries no factor above 1
Keys that describe it are not read: kind, how, what, nominal, recording, robot, least, first_below, evals, gap. Any
other key is refused, and so is one that stands twice.
An answer has id; without, if sensors are left out; start_deviation, of a bag's motion: the largest difference of a
joint's first waypoint from where the bag has it (null: not known); lower, upper: bounds of the least distance over the
whole motion, m (0 where bodies overlap); t, pair, points: where upper is attained (points in the world);
for each margin a verdict, free, below or
undecided, and first_below: null if free, {"t": [from, to], "pair"} if below. The distance is at least the margin
at all instants before `from`, and below it at `to`. An undecided margin has "above_until" instead of [from, to].
profile is a list of {"t": [from, to], "lower", "upper", "pair"} that covers the motion; time_scaling has factor,
factor_above (no larger one is admissible; null: no limit), t, pair, zone (null: a margin that a stop does not keep).
A line that cannot be answered gets {"line": n, "error": "..."}, and the other lines are answered.)";

constexpr const char* kExample =
    R"(Exit status: 0 every line answered and no expectation failed, 1 some are not, 2 wrong usage or unreadable files,
3 a cell has errors.

Example: is this motion 2 cm away from everything?
  echo '{"id": "lift", "joints": ["shoulder", "elbow"], "times_s": [0, 1.5], "positions": [[0, 0], [0.4, -0.8]]}' |
    clearance-ask cell.yaml - --out - --expect-min-distance 0.02)";

int run(const AskOptions& options) {
  for (const std::string& file :
       {options.out, options.files.profile, options.files.plot, options.files.page}) {
    if (file.empty()) continue;
    if (!output_is_not_an_input("clearance-ask", file, {options.cell, options.motions}))
      return kUsage;
  }
  std::ifstream file_in;
  const bool is_bag = options.motions != "-" && bag_format(options.motions) != BagFormat::kOther;
  if (is_bag && std::filesystem::is_directory(options.cell)) {
    print(stderr, "clearance-ask: found a folder of cells, and a bag; expected one cell for it\n");
    return kUsage;
  }
  if (options.motions != "-" && !is_bag) {
    file_in.open(options.motions);
    if (!file_in || std::filesystem::is_directory(options.motions)) {
      print(stderr, "clearance-ask: {}\n", cannot_read(options.motions));
      return kUsage;
    }
  }
  Answering answering(options);
  if (const std::string wrong = answering.read_margins(); !wrong.empty()) {
    print(stderr, "clearance-ask: {}\n", wrong);
    return kUsage;
  }
  if (!answering.read()) return kBadCell;
  std::ofstream file_out;
  if (options.out != "-") {
    file_out.open(options.out);
    if (!file_out) {
      print(stderr, "clearance-ask: {}\n", cannot_write(options.out));
      return kUsage;
    }
  }
  if (const std::string error = answering.begin_report(); !error.empty()) {
    print(stderr, "clearance-ask: {}\n", error);
    return kUsage;
  }
  std::ostream& out = options.out == "-" ? std::cout : file_out;
  if (is_bag) return answering.answer_bag(out);
  return answering.answer_all(options.motions == "-" ? std::cin : file_in, out);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  clearance::AskOptions options;
  clearance::CommandLine line{clearance::kDescription, clearance::kExample};
  line.options = {
      {"CELL", &options.cell, "Cell file, or a folder of cells", clearance::required()},
      {"MOTIONS", &options.motions,
       "File of motions, one a line, or a ROS 2 bag; - is standard input", clearance::required()},
      {"--out", &options.out, "File for the answers; - is standard output", clearance::required()},
      {"--margin",
       &options.margins,
       "Margins, m; 0 asks for contact; repeatable. A,B=0.05 is one of the pairs of two objects or "
       "groups, ZONE=0.05 of a zone. Others count for all pairs but those that a robot's own build "
       "keeps nearer in every posture",
       {.shows_default = true, .takes_all = true}},
      {"--tolerance", &options.tolerance, "Largest gap between lower and upper, m",
       clearance::positive_number(), clearance::shown()},
      {"--expect-min-distance", &options.expected,
       "A motion that is not certainly this far from everything, m, fails",
       clearance::number_from_zero()},
      {"--others-still", &options.others_still,
       "Objects that are neither fixed nor part of a robot do not move"},
      {"--without",
       &options.without,
       "Leave out what this sensor of the cell sees, which no motion states; repeatable. Each "
       "answer "
       "names it",
       {.takes_all = true}},
      {"--stoppable", &options.stoppable,
       "Bounds and margins count stops that begin at any instant of a motion, too"},
      {"--verdicts", &options.only_verdicts,
       "Only the verdicts of margins; lower and first_below are then as good as these needed"},
      {"--repeat", &options.repeat, "Ask N times, for the times on stderr",
       clearance::whole_number_in(1, 1'000'000)},
      {"--threads", &options.threads,
       "Answer in N threads, 256 motions for each at a time; the answers have the same bits",
       clearance::whole_number_in(1, 256)},
      {"--profile", &options.files.profile,
       "CSV for the distance over time: bounds for each part of each motion"},
      {"--plot", &options.files.plot, "SVG for the same, by gnuplot"},
      {"--report", &options.files.page, "Page of HTML with plot and table, for a review"},
  };
  if (const auto done = clearance::parse(line, argc, argv)) return *done;
  return clearance::run_program("clearance-ask",
                                [&](clearance::StopSignal&) { return clearance::run(options); });
}
