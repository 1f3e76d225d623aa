#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <map>

#include "config/text/sentences.hpp"
#include "monitor/app/output_file.hpp"
#include "monitor/app/print.hpp"
#include "monitor/app/program.hpp"
#include "monitor/dds/robot_description.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/recording/reader.hpp"
#include "monitor/recording/recorded_cell.hpp"
#include "monitor/recording/robot_description.hpp"
#include "monitor/replay/explained_places.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/reference_check.hpp"
#include "monitor/replay/report_csv.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tools/replay/arguments.hpp"
#include "tools/replay/junit.hpp"
#include "tools/replay/share_balance.hpp"
#include "tools/shared/named_distance.hpp"
#include "tools/shared/progress_bar.hpp"

namespace clearance {
namespace {

void say(const std::string& text) { print(stderr, "clearance-replay: {}\n", text); }

// The robot of the command line, or the robot that the bag describes, as a cell.
std::optional<CellResult> read_robot(const CheckArguments& arguments, const CellOptions& options) {
  SingleRobotOptions robot = arguments.robot;
  if (!robot.urdf.empty()) return read_single_robot(robot, options);
  const std::optional<std::string> described = robot_description(arguments.recording());
  if (!described) {
    say(
        fmt::format("{} holds no cell and no robot_description; expected --urdf and --srdf of its "
                    "robot, or --cell with a cell file that names the robot under 'robots:'",
                    arguments.recording()));
    return std::nullopt;
  }
  robot.urdf = keep_robot_description(*described);
  return read_single_robot(robot, options);
}

// The cell of the command line, or the cell in the recording.
std::optional<CellResult> find_cell(const CheckArguments& arguments,
                                    std::map<std::string, double>& mesh_errors) {
  CellOptions options = told_on_stderr();
  options.mesh_errors = &mesh_errors;
  if (!arguments.cell.empty()) return read_cell(arguments.cell, options);
  if (!arguments.robot.urdf.empty() || is_input_log(arguments.recording())) {
    return read_robot(arguments, options);
  }
  const RecordingOutline found = outline(arguments.recording());
  if (!found.error.empty()) {
    say(found.error);
    return std::nullopt;
  }
  std::optional<CellResult> cell = recorded_cell(arguments.recording(), found, options);
  if (!cell) say("the recording holds no cell: give one with --cell");
  return cell;
}

OfflineReplayOptions options_of(const CheckArguments& arguments) {
  OfflineReplayOptions options;
  options.continued_in.assign(arguments.span.recordings.begin() + 1,
                              arguments.span.recordings.end());
  options.tick_hz = arguments.tick_hz;
  options.joint_topics = arguments.joint_topics;
  options.start_s = arguments.span.start_s;
  options.end_s = arguments.span.end_s;
  if (arguments.compare) options.compare = Comparison::kBits;
  if (arguments.compare_bounds) options.compare = Comparison::kBounds;
  options.evaluate_all = arguments.evaluate_all || !arguments.reference.empty();
  options.gradients = arguments.gradients;
  options.reference = arguments.reference;
  options.tolerance = arguments.tolerance;
  if (arguments.between.empty()) options.expect_min_distance = arguments.expect_min_distance;
  options.allow_unknown = arguments.allow_unknown;
  options.expect_no_zone = arguments.expect_no_zone;
  return options;
}

// To stderr where --balance prints its key on stdout.
void print_summary(const OfflineReplay& replay, const CheckArguments& arguments, double elapsed_s) {
  std::FILE* const out = arguments.balance > 0 ? stderr : stdout;
  const std::optional<double> tolerance = arguments.tolerance;
  const double recorded_s = static_cast<double>(replay.last_ns - replay.first_ns) * 1e-9;
  print(out, "{}, {:.3f} s recorded, replayed in {:.3f} s\n", counted(replay.ticks, "tick"),
        recorded_s, elapsed_s);
  if (replay.not_judged > 0) {
    print(out, "not judged: {} of {}\n", replay.not_judged, counted(replay.ticks, "tick"));
  }
  if (replay.closest) {
    const PairReport& pair = *replay.closest;
    print(out, "closest: {}, {:.9g} m ({:.9g} to {:.9g}) at {}\n", replay.closest_pair,
          pair.distance, pair.lower, pair.upper, replay.closest_tick.text());
  }
  if (replay.compared > 0) {
    print(out, "{} compared\n", counted(replay.compared, "report"));
  }
  if (replay.reference) {
    const ReferenceTotals& totals = *replay.reference;
    print(out,
          "{} reference distances compared, largest difference {:.2g} m; {} off by more than {:g} "
          "m, {} outside of the bounds{}\n",
          totals.compared, totals.largest, totals.off, tolerance.value_or(kReferenceTolerance),
          totals.outside, tolerance ? " by more than that" : "");
  }
}

// Reads --between: "A,B=METRES", where B and the distance may be left out. Returns what is wrong.
std::string read_between(const CheckArguments& arguments, std::vector<ExpectedDistance>& read) {
  for (const std::string& text : arguments.between) {
    auto found = read_named_distance(text);
    if (const auto* wrong = std::get_if<std::string>(&found)) return "--between: " + *wrong;
    auto& named = std::get<NamedDistance>(found);
    if (!named.metres) named.metres = arguments.expect_min_distance;
    if (!named.metres) {
      return fmt::format("--between {}: no distance; expected '{}=0.05', or --expect-min-distance",
                         text, text);
    }
    ExpectedDistance expected{*named.metres, std::move(named.a), std::move(named.b)};
    read.push_back(std::move(expected));
  }
  return {};
}

// The outputs of -o, --csv and --balance.
class Outputs {
 public:
  Outputs(const CheckArguments& arguments, const Cell& cell) : arguments_(arguments) {
    if (!arguments.out.empty()) recording_.emplace(arguments.out, cell);
    if (!arguments.csv.empty()) csv_.emplace(arguments.csv, cell.scene, !arguments.published);
    if (arguments.balance > 0) balance_.emplace(arguments.balance);
  }
  // False, after saying why, when a file cannot be made.
  [[nodiscard]] bool ok() const { return !csv_ || said(csv_->error()); }

  void add(const ReplayedTick& tick) {
    begun_ = true;
    if (recording_) recording_->add(tick);
    if (csv_) csv_->add(tick);
    if (balance_) balance_->add(tick);
  }
  // False, after saying why, when not all is written.
  bool close() {
    const bool recorded = !recording_ || recording_->close() || said(recording_->error());
    if (recording_ && recorded && !recording_->without_files().empty()) {
      say(fmt::format("the files that the cell names are not in {}: {}", arguments_.out,
                      recording_->without_files()));
    }
    const bool tabled = !csv_ || csv_->close() || said(csv_->error());
    const bool balanced = !balance_ || said(balance_->error());
    if (balance_) print(stdout, "{}", balance_->text());
    return recorded && tabled && balanced;
  }
  // A recording is created with its first tick; before that, a file of this name is not ours.
  void abandon() {
    const bool recorded = recording_ && begun_, tabled = csv_.has_value();
    recording_.reset();
    csv_.reset();
    if (recorded) remove_unfinished("clearance-replay", arguments_.out);
    if (tabled) remove_unfinished("clearance-replay", arguments_.csv);
  }

 private:
  // Prints the error; true: there is none.
  static bool said(const std::string& error) {
    if (!error.empty()) say(error);
    return error.empty();
  }

  const CheckArguments& arguments_;
  std::optional<ReportRecorder> recording_;
  std::optional<ReportCsv> csv_;
  std::optional<ShareBalance> balance_;
  bool begun_ = false;
};

// Compares where trackers see links with where joints place them.
class TrackedLinks {
 public:
  // Returns what is wrong with the texts, or nothing. The cell must outlive this.
  std::string read(const std::vector<std::string>& texts, const Scene& scene) {
    for (const std::string& text : texts) {
      const std::size_t equals = text.find('=');
      const std::string object = text.substr(0, equals);
      const auto at = std::ranges::find(scene.objects, object, &Object::name);
      if (equals == std::string::npos || at == scene.objects.end())
        return fmt::format("--errors {}: expected OBJECT=LINK with an object of the cell", text);
      const auto link = link_by_name(scene, text.substr(equals + 1));
      if (const auto* fault = std::get_if<std::string>(&link))
        return fmt::format("--errors {}: {}", text, *fault);
      tracked_.push_back({static_cast<std::uint32_t>(at - scene.objects.begin()), 0,
                          ExplainedPlaces(scene, std::get<LinkByName>(link))});
    }
    return {};
  }
  // Each new pose counts, at most one in 10 ms.
  void add(const Monitor& monitor) {
    constexpr std::int64_t kApartNs = 10'000'000;
    for (auto& [object, stamp_ns, places] : tracked_) {
      const PresentPose at = monitor.present_pose(object);
      const std::int64_t now_ns = monitor.stamp_ns(object);
      if (at.state != PresentPose::State::kUsable || now_ns < stamp_ns + kApartNs) continue;
      if (places.add(monitor, at.world_from_body.position, object)) stamp_ns = now_ns;
    }
  }
  // Prints what was found; false: the stated errors do not explain all, or nothing was compared.
  [[nodiscard]] bool tell() const {
    bool explained = true;
    for (const auto& [object, stamp_ns, places] : tracked_) {
      if (places.size() == 0) {
        say("--errors: the object and the link were never known at once");
        explained = false;
        continue;
      }
      print(stdout, "{}", places.text());
      explained = explained && places.factor() <= 1.0;
    }
    return explained;
  }

 private:
  struct Tracked {
    std::uint32_t object;
    std::int64_t stamp_ns;  // of the last pose that counted
    ExplainedPlaces places;
  };
  std::vector<Tracked> tracked_;
};

// Closes or removes the outputs of a finished replay, and returns the exit code.
int finish(const OfflineReplay& replay, Outputs& outputs) {
  bool written = true;
  if (replay.stopped) {
    outputs.abandon();
  } else {
    written = outputs.close();
  }
  if (!replay.ok() || !written) return kFailed;
  return replay.is_whole() ? kOk : kIncomplete;
}

int replay_in(const Cell& cell, const CheckArguments& arguments,
              const std::map<std::string, double>& mesh_errors, StopSignal& stop) {
  std::map<std::string, double> joints;
  if (const auto wrong = read_joint_positions(arguments.joints, joints); !wrong.empty()) {
    say(wrong);
    return kUsage;
  }
  if (!joints.empty() && !is_input_log(arguments.recording())) {
    say(
        fmt::format("--joint is for bags and joint logs, and {} is a recording of Clearance; "
                    "clearance-record --joint puts such a joint into it",
                    arguments.recording()));
    return kUsage;
  }
  if (arguments.balance > cell.scene.pairs.size()) {
    say(an_empty_share(arguments.balance, cell.scene.pairs.size()));
    return kFailed;
  }
  OfflineReplayOptions options = options_of(arguments);
  if (const auto wrong = read_between(arguments, options.expect_between); !wrong.empty()) {
    say(wrong);
    return kUsage;
  }
  TrackedLinks tracked;
  if (const auto wrong = tracked.read(arguments.errors, cell.scene); !wrong.empty()) {
    say(wrong);
    return kUsage;
  }
  Outputs outputs(arguments, cell);
  if (!outputs.ok()) return kFailed;

  ProgressBar bar;
  options.joints = joints;
  options.mesh_errors = mesh_errors;
  options.progress = [&bar](double share) { bar.show(share, "replayed"); };
  options.stop = [&stop] { return stop.wait(0); };
  const auto started = std::chrono::steady_clock::now();
  const OfflineReplay replay =
      replay_offline(cell, arguments.recording(), options, [&](const ReplayedTick& tick) {
        outputs.add(tick);
        tracked.add(tick.monitor);
      });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  bar.finish();
  print(stderr, "{}", replay.text());
  if (!arguments.junit.empty()) {
    const std::string& name = arguments.recording();
    if (const auto wrong =
            write_junit(arguments.junit, cell.scene.name, name, replay, elapsed.count());
        !wrong.empty()) {
      say(wrong);
      return kFailed;
    }
  }
  if (!replay.error.empty()) {
    outputs.abandon();
    return kFailed;
  }
  print_summary(replay, arguments, elapsed.count());
  const bool explained = tracked.tell();
  const int finished = finish(replay, outputs);
  return finished == kOk && !explained ? kFailed : finished;
}

bool are_one_file(const std::filesystem::path& first, const std::filesystem::path& second) {
  if (first.empty() || second.empty()) return false;
  return std::filesystem::weakly_canonical(std::filesystem::absolute(first)) ==
         std::filesystem::weakly_canonical(std::filesystem::absolute(second));
}

}  // namespace

int check_recording(const CheckArguments& arguments, StopSignal& stop) {
  const std::array outputs = {arguments.out, arguments.csv, arguments.junit};
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::string &one = outputs[i], &next = outputs[(i + 1) % outputs.size()];
    if (!are_one_file(one, next)) continue;
    say(fmt::format("two outputs name the same file, {}; expected one for each", next));
    return kUsage;
  }
  for (const std::string& output : outputs) {
    for (const std::string& recording : arguments.span.recordings) {
      if (!output_is_not_an_input("clearance-replay", output,
                                  {recording, arguments.cell, arguments.reference})) {
        return kUsage;
      }
    }
    if (!can_create("clearance-replay", output, arguments.force)) return kFailed;
  }
  std::map<std::string, double> mesh_errors;
  std::optional<CellResult> read = find_cell(arguments, mesh_errors);
  if (!read) return kFailed;
  std::optional<Cell> cell = cell_or_errors(std::move(*read));
  if (!cell) {
    const bool is_recorded = arguments.cell.empty() && arguments.robot.urdf.empty() &&
                             !is_input_log(arguments.recording());
    if (is_recorded)
      say("this is the cell as the recording keeps it, without its mesh files; give the cell file "
          "with --cell");
    return kBadCell;
  }
  cell->scene.gradients = cell->scene.gradients || arguments.gradients;
  cell->ros.use_sim_time = cell->ros.use_sim_time || arguments.use_sim_time;
  if (!arguments.true_meshes) mesh_errors.clear();
  return replay_in(*cell, arguments, mesh_errors, stop);
}

}  // namespace clearance
