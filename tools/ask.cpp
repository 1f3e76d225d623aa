// clearance-ask: certified distances of whole motions, one JSON object a line in and out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "monitor/app/options.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/ask/asker.hpp"
#include "monitor/ask/robots_of_question.hpp"
#include "monitor/bags/bag.hpp"
#include "monitor/files/file_error.hpp"
#include "tools/ask/bag_motions.hpp"
#include "tools/ask/motion_json.hpp"
#include "tools/ask/motion_report.hpp"

namespace clearance {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr const char* kDescription =
    R"(Says of a motion before it is made how near it comes to anything: at all instants, not at samples.

MOTIONS may be a bag of ROS 2: then each trajectory_msgs/JointTrajectory is a motion, and all other joints are where the
joint states before it have them. Otherwise it has one motion a line, below.

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
  poses       {"OBJECT": [x, y, z, qw, qx, qy, qz]} of objects that are neither fixed nor part of a robot;
              such an object comes nearer by its max_speed x time, or with "others": "still" not at all
  turn_speeds {"OBJECT": rad/s} of such objects on which robots stand; without it they may rotate by any angle
  margins     m, instead of --margin
  beside      [{joints, times_s, positions, velocities}] of other robots, which rest before and after
  moving      {"OBJECT": {"times_s": [...], "poses": [[x, y, z, qw, qx, qy, qz], ...]}}: stated motions of objects
  payloads    [{"name", "link", "pose", "touch": [...]}]: what links carry, an object of the cell or a new one with
              "box": [x, y, z], "sphere": radius, "cylinder": [radius, length] or "vertices": [[x, y, z], ...]
  profile     true, or {"pair": ["A", "B"], "tolerance": m, "points": N}: the distance over time
  time_scaling  true: the largest factor by which the motion may be timed faster so that S_p of zones holds
An answer has id; lower, upper: bounds of the least distance over the whole motion, m (0 where bodies overlap);
t, pair, points: where upper is attained (points in the world); for each margin a verdict, free, below or
undecided, and first_below: null if free, {"t": [from, to], "pair"} if below. The distance is at least the margin
at all instants before `from`, and below it at `to`. An undecided margin has "above_until" instead of [from, to].
profile is a list of {"t": [from, to], "lower", "upper", "pair"} that covers the motion; time_scaling has factor,
factor_above (no larger one is admissible; null: no limit), t, pair, zone.
A line that cannot be answered gets {"line": n, "error": "..."}, and the other lines are answered.)";

constexpr const char* kExample =
    R"(Exit status: 0 every line answered and no expectation failed, 1 some are not, 2 wrong usage or unreadable files,
3 a cell has errors.

Example: is this motion 2 cm away from everything?
  echo '{"id": "lift", "joints": ["shoulder", "elbow"], "times_s": [0, 1.5], "positions": [[0, 0], [0.4, -0.8]]}' |
    clearance-ask cell.yaml - --out - --expect-min-distance 0.02)";

struct Options {
  std::string cell, motions, out;
  std::vector<double> margins{0.0, 0.01, 0.05};
  double tolerance = 1e-3;
  std::optional<double> expected;
  std::uint64_t work_limit = 1'000'000;
  bool others_still = false, only_verdicts = false;
  int repeat = 1;
  unsigned threads = 1;
  MotionReportFiles files;
};

double percentile(std::vector<double>& sorted, double share) {
  const auto at = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

class Program {
 public:
  explicit Program(const Options& options)
      : options_(options),
        report_(options.files, options.motions + " in " + options.cell, options.expected) {
    defaults_.margins = options.margins;
    defaults_.tolerance = options.tolerance;
    defaults_.work_limit = options.work_limit;
    defaults_.only_margins = defaults_.only_verdicts = options.only_verdicts;
    if (options.others_still) defaults_.others = OthersMove::kNot;
    if (options.expected) defaults_.margins.push_back(*options.expected);
    if (options.files.any()) defaults_.profile.emplace();
  }

  // Reads the cell of all motions; a folder is read as motions name its cells.
  [[nodiscard]] bool read() {
    if (std::filesystem::is_directory(options_.cell)) return true;
    return add("", options_.cell);
  }
  [[nodiscard]] std::string begin_report() { return report_.begin(); }

  int answer_all(std::istream& in, std::ostream& out) {
    std::size_t number = 0;
    for (std::string text; std::getline(in, text);) {
      ++number;
      if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
      AskedMotion motion{.where = std::to_string(number)};
      try {
        const nlohmann::json line = nlohmann::json::parse(text);
        if (line.contains("id")) motion.id = line["id"];
        motion.question = read_question(line, defaults_);
        motion.place = &place_of(line);
      } catch (const BadMotion& error) {
        motion.error = error.what();
      } catch (const nlohmann::json::exception& error) {
        motion.error = std::string("not a motion: ") + error.what();
      }
      take(std::move(motion), out);
    }
    return conclude(in.bad() ? "cannot read " + options_.motions : "", "a JSON object a line", out);
  }

  // The motions of a bag.
  int answer_bag(std::ostream& out) {
    const std::string error = for_each_motion(options_.motions, [&](const BagMotion& found) {
      AskedMotion motion{.where = found.id, .id = found.id, .place = places_.at("").get()};
      if (const auto* reason = std::get_if<std::string>(&found.motion)) {
        motion.error = *reason;
      } else {
        motion.question = question_of(found, motion.scene());
      }
      take(std::move(motion), out);
    });
    return conclude(error, "messages of trajectory_msgs/msg/JointTrajectory", out);
  }

 private:
  // One thread answers each motion at once; several threads wait for the last one.
  void take(AskedMotion motion, std::ostream& out) {
    ++lines_;
    if (options_.threads > 1) {
      waiting_.push_back(std::move(motion));
      return;
    }
    if (motion.error.empty()) ask(motion);
    write(motion, out);
  }

  void ask(AskedMotion& motion) {
    double least_us = 1e300;
    for (int i = 0; i < options_.repeat; ++i) {
      const auto start = std::chrono::steady_clock::now();
      motion.error = motion.place->asker.ask(motion.question, motion.answer).value_or("");
      if (!motion.error.empty()) return;
      const std::chrono::duration<double, std::micro> taken =
          std::chrono::steady_clock::now() - start;
      least_us = std::min(least_us, taken.count());
    }
    times_us_.push_back(least_us);
  }

  // Place by place, since the memory for questions is that of one scene.
  void ask_waiting() {
    std::map<AskedPlace*, std::vector<std::size_t>> by_place;
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
      if (waiting_[i].error.empty()) by_place[waiting_[i].place].push_back(i);
    }
    for (const auto& [place, indices] : by_place) {
      std::vector<Question> questions;
      for (const std::size_t i : indices) questions.push_back(std::move(waiting_[i].question));
      std::vector<Answer> answers(indices.size());
      std::vector<std::string> faults(indices.size());
      ask_all(place->cell.scene, questions, answers, faults, options_.threads);
      for (std::size_t k = 0; k < indices.size(); ++k) {
        AskedMotion& motion = waiting_[indices[k]];
        motion.question = std::move(questions[k]);
        motion.answer = std::move(answers[k]);
        motion.error = std::move(faults[k]);
      }
    }
  }

  void write(AskedMotion& motion, std::ostream& out) {
    OrderedJson line;
    if (motion.error.empty()) {
      if (!motion.id.is_null()) line["id"] = motion.id;
      line.update(answer_line(motion.answer, motion.scene(), motion.question));
      for (const MarginAnswer& margin : motion.answer.margins)
        undecided_ += margin.verdict == Verdict::kUndecided ? 1 : 0;
      expect(motion);
    } else {
      if (bad_++ == 0) print(stderr, "{}:{}: {}\n", options_.motions, motion.where, motion.error);
      const bool is_of_bag = motion.id.is_string() && motion.where == motion.id;
      if (is_of_bag) {
        line["id"] = motion.id;
      } else {
        line["line"] = std::stoull(motion.where);
      }
      line["error"] = motion.error;
    }
    out << line.dump(-1, ' ', false, OrderedJson::error_handler_t::replace) << '\n';
    report_.add(motion);
  }

  // `error` says why the input could not be read to its end.
  int conclude(std::string error, const std::string& expected, std::ostream& out) {
    ask_waiting();
    for (AskedMotion& motion : waiting_) write(motion, out);
    out.flush();
    if (error.empty() && lines_ == 0)
      error = options_.motions + " has no motion; expected " + expected;
    if (error.empty() && !out) error = "could not write all answers to " + options_.out;
    if (error.empty()) error = report_.finish();
    if (!error.empty()) {
      print(stderr, "clearance-ask: {}\n", error);
      return kUsage;
    }
    summarise();
    if (bad_cells_ > 0) return kBadCell;
    return bad_ + failed_ > 0 ? kFailed : kOk;
  }

  bool add(const std::string& scene, const std::filesystem::path& file) {
    std::optional<Cell> cell = cell_or_errors(read_cell(file, told_on_stderr()));
    if (cell) places_[scene] = std::make_unique<AskedPlace>(std::move(*cell));
    return cell.has_value();
  }

  AskedPlace& place_of(const nlohmann::json& motion) {
    if (!std::filesystem::is_directory(options_.cell)) return *places_.at("");
    const std::string scene = motion.at("scene").get<std::string>();
    const auto found = places_.find(scene);
    if (found != places_.end()) return *found->second;
    const std::filesystem::path file = std::filesystem::path(options_.cell) / (scene + ".yaml");
    if (!add(scene, file)) {
      ++bad_cells_;
      throw BadMotion("the cell " + file.string() + " cannot be read");
    }
    return *places_.at(scene);
  }

  // A bag has joint states of robots that the cell does not have, too.
  [[nodiscard]] Question question_of(const BagMotion& motion, const Scene& scene) const {
    Question question = defaults_;
    question.motion = std::get<JointTrajectory>(motion.motion);
    const std::vector<bool> is_of_question = robots_of_question(scene, question);
    for (const StatedJoint& joint : motion.joints) {
      const auto found = std::ranges::find(scene.variables, joint.name, &JointVariable::name);
      if (found == scene.variables.end()) continue;
      if (is_of_question[found->robot]) {
        question.held.push_back({joint.name, joint.position});
      } else {
        question.joints.push_back(joint);
      }
    }
    return question;
  }

  // The expected distance is the last margin.
  void expect(AskedMotion& motion) {
    const Answer& answer = motion.answer;
    if (!options_.expected || answer.margins.empty()) return;
    const MarginAnswer& margin = answer.margins.back();
    if (margin.verdict == Verdict::kFree) return;
    ++failed_;
    motion.as_expected = false;
    print(stderr, "{}: {} - {} {} {} m from {} s on; the least distance is in [{:.6f}, {:.6f}] m\n",
          motion.name(), object_name(motion.scene(), motion.question, margin.first),
          object_name(motion.scene(), motion.question, margin.second),
          margin.verdict == Verdict::kBelow ? "comes below" : "may come below", margin.margin,
          margin.above_until, answer.lower, answer.upper);
  }

  void summarise() {
    std::sort(times_us_.begin(), times_us_.end());
    print(stderr, "{} motions, {} with errors, {} verdicts undecided", lines_, bad_, undecided_);
    if (options_.expected) print(stderr, ", {} not as expected", failed_);
    if (!times_us_.empty()) {
      print(stderr, "; p50 {:.1f} us, p99 {:.1f} us, max {:.1f} us a motion",
            percentile(times_us_, 0.5), percentile(times_us_, 0.99), times_us_.back());
    }
    print(stderr, "\n");
  }

  const Options& options_;
  Question defaults_;
  MotionReport report_;
  std::vector<AskedMotion> waiting_;
  std::map<std::string, std::unique_ptr<AskedPlace>> places_;
  std::vector<double> times_us_;
  std::size_t lines_ = 0, bad_ = 0, undecided_ = 0, failed_ = 0, bad_cells_ = 0;
};

int run(const Options& options) {
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
  Program program(options);
  if (!program.read()) return kBadCell;
  std::ofstream file_out;
  if (options.out != "-") {
    file_out.open(options.out);
    if (!file_out) {
      print(stderr, "clearance-ask: {}\n", cannot_write(options.out));
      return kUsage;
    }
  }
  if (const std::string error = program.begin_report(); !error.empty()) {
    print(stderr, "clearance-ask: {}\n", error);
    return kUsage;
  }
  std::ostream& out = options.out == "-" ? std::cout : file_out;
  if (is_bag) return program.answer_bag(out);
  return program.answer_all(options.motions == "-" ? std::cin : file_in, out);
}

}  // namespace
}  // namespace clearance

int main(int argc, char** argv) {
  CLI::App app(clearance::kDescription, "clearance-ask");
  app.footer(clearance::kExample);
  clearance::Options options;
  app.add_option("CELL", options.cell, "Cell file, or a folder of cells")->required();
  app.add_option("MOTIONS", options.motions,
                 "File of motions, one a line, or a ROS 2 bag; - is standard input")
      ->required();
  app.add_option("--out", options.out, "File for the answers; - is standard output")->required();
  app.add_option("--margin", options.margins, "Margins, m; 0 asks for contact; repeatable")
      ->check(clearance::number_from_zero())
      ->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "Largest gap between lower and upper, m")
      ->check(clearance::positive_number())
      ->capture_default_str();
  app.add_option("--expect-min-distance", options.expected,
                 "A motion that is not certainly this far from everything, m, fails")
      ->check(clearance::number_from_zero());
  app.add_option("--work-limit", options.work_limit, "Most distance queries for a motion")
      ->check(CLI::Range(1, 1000000000))
      ->capture_default_str();
  app.add_flag("--others-still", options.others_still,
               "Objects that are neither fixed nor part of a robot do not move");
  app.add_flag(
      "--verdicts", options.only_verdicts,
      "Only the verdicts of margins; lower and first_below are then as good as these needed");
  app.add_option("--repeat", options.repeat, "Ask N times, for the times on stderr")
      ->check(CLI::Range(1, 1000000));
  app.add_option("--threads", options.threads,
                 "Answer in N threads, once all motions are read; the answers have the same bits")
      ->check(CLI::Range(1, 256));
  app.add_option("--profile", options.files.profile,
                 "CSV for the distance over time: bounds for each part of each motion");
  app.add_option("--plot", options.files.plot, "SVG for the same, by gnuplot");
  app.add_option("--report", options.files.page, "Page of HTML with plot and table, for a review");
  if (const auto done = clearance::parse(app, argc, argv)) return *done;
  return clearance::run_program("clearance-ask",
                                [&](clearance::StopSignal&) { return clearance::run(options); });
}
