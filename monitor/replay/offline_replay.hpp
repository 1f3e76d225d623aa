// Runs Monitor::tick on a recording, a ROS 2 bag or a joint log, without a clock and without DDS.
// It makes the same reports again as fast as they can be computed. It is meant for a user's own
// tests. These call find_package(clearance) and link clearance::replay:
//
//   #include <config/cell/cell_file.hpp>
//   #include <monitor/replay/offline_replay.hpp>
//
//   const CellResult cell = read_cell("cell.yaml");
//   const OfflineReplay replay =
//       replay_offline(std::get<Cell>(cell), "run.mcap",
//                      {.expect_min_distance = 0.05, .expect_no_zone = {"stop"}});
//   EXPECT_TRUE(replay.ok() && replay.is_whole()) << replay.text();
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/replay/comparison.hpp"
#include "monitor/replay/expected_distance.hpp"
#include "monitor/replay/reference_totals.hpp"

namespace clearance {

class Monitor;  // monitor/tick/monitor.hpp, in the source tree

// All are optional: without any, the replay only runs.
struct OfflineReplayOptions {
  // Ticks in this window (s after the first tick) are compared, judged and handed out. Earlier
  // ticks are run all the same, since bounds and zones depend on them. Where the recorded time goes
  // back, it is counted on from there.
  double start_s = 0.0;
  double end_s = std::numeric_limits<double>::infinity();

  std::optional<Comparison> compare = {};  // with the recorded reports and zones

  // The further files of a recording of several files, in their order.
  std::vector<std::filesystem::path> continued_in = {};

  // Ticks a second. It is used only if the recording holds no reports, which state the times of the
  // ticks. Zero means one tick for each time at which something came. If not set, it is the cell's
  // rate for a bag or a joint log, and 0 for Clearance's own recordings.
  std::optional<double> tick_hz = {};
  // Further ticks of a bag or a joint log at these times, ns, in ascending order.
  std::vector<std::int64_t> also_at = {};
  // Topics of joint states of a bag (monitor/recording); empty: all that are named joint_states.
  std::vector<std::string> joint_topics = {};
  // Positions of joints that a bag or joint log does not have, by name, rad or m.
  std::map<std::string, double> joints = {};

  // An expectation rests on pairs. It is judged from the first tick in which their moving objects
  // are all known and on time; before, only a pair that is certainly too near counts. Later, a pair
  // that is unknown breaks it. If an object was late for at most 1 s when the recording ended, its
  // pairs count in that time only where they are certainly too near (Expectations).
  // Every pair's distance is certified to be at least this, m.
  std::optional<double> expect_min_distance = {};
  // The same of the pairs between two objects or groups, or of a zone.
  std::vector<ExpectedDistance> expect_between = {};
  // Names of zones that are never active.
  std::vector<std::string> expect_no_zone = {};
  double allow_unknown = 0.0;  // the share of judged ticks in which a pair may be unknown

  bool evaluate_all = false;  // every pair in every tick, whatever it costs
  bool gradients = false;     // also where the cell does not ask for them

  // Distances that something else computed (monitor/replay/reference_check.hpp): every one of a
  // pair and tick of the replay is met and lies within the bounds. A pair that a tick left out does
  // not count as met, which evaluate_all prevents.
  std::filesystem::path reference = {};  // empty: none
  // The tolerance of a reference, m: distances and bounds may differ by that much. If not set,
  // distances may differ by 1e-6 m, and the reference must lie within the bounds exactly as it is
  // written.
  std::optional<double> tolerance = {};
  // The reference is of the meshes themselves: by an object's name, the error of its parts, m
  // (CellOptions::mesh_errors). Our distances may be smaller by it. Empty: it is of the parts.
  std::map<std::string, double> mesh_errors = {};

  std::function<void(double share)> progress = {};  // 0 to 1, about a hundred times
  std::function<bool()> stop = {};  // asked before every tick: true ends the replay there
};

// The tick that was just run.
struct ReplayedTick {
  const Report& report;
  std::span<const SourceUse> sources;
  const Monitor& monitor;
  const Cell& cell;    // in force; valid while the replay runs
  SceneInForce since;  // in the cycles of the replay
};

// The numbers of a tick. The replay counts its ticks from 1; the recorded daemon may have been
// further by then.
struct TickNumber {
  std::uint64_t cycle = 0;     // of the replay; 0: no tick, all of it
  std::uint64_t recorded = 0;  // of the daemon; as `cycle` where the recording holds no reports
  // "tick 12", or "tick 12 of the replay, 4012 of the daemon".
  [[nodiscard]] std::string text() const;
};

// The first failure of one expectation or comparison.
struct ReplayFailure {
  TickNumber tick;
  std::int64_t now_ns = 0;
  double time_s = 0.0;      // after the first tick of the recording
  std::string what;         // which pair, zone or field, and the figures
  std::string expectation;  // ExpectationOutcome::expectation; empty: it is of a comparison
};

// An expectation and its least distance in the judged ticks, whether it is met or not.
struct ExpectationOutcome {
  std::string expectation;  // "at least 0.05 m of arm - table", "zone 'stop'"
  std::string least;        // pair and figure; empty: no pair was known in any of them
  TickNumber tick;
  double time_s = 0.0;  // after the first tick of the recording
};

// The result of a whole replay.
struct OfflineReplay {
  std::string error;                    // not empty: it could not be run at all
  std::string damage;                   // not empty: the recording was read up to a damaged place
  bool stopped = false;                 // options.stop ended it: nothing is known of the ticks that
                                        // follow
  std::vector<std::string> notes;       // what a person should know, in sentences
  std::vector<ReplayFailure> failures;  // the first of each expectation and of the comparison
  std::vector<ExpectationOutcome> expectations;  // all of them, if the replay came to its end

  std::uint64_t ticks = 0;  // in the window, as all counts and times of ticks here
  std::uint64_t compared = 0, batches = 0;
  std::uint64_t not_judged = 0;  // the most ticks in which one expectation was not judged
  std::uint64_t joins = 0;       // states of a partner that the daemon took over
  std::int64_t first_ns = 0, last_ns = 0;
  std::optional<PairReport> closest;  // the smallest distance of all ticks handed out
  std::string closest_pair;           // its name
  TickNumber closest_tick;
  std::array<std::uint64_t, kRejects> rejected{};
  std::optional<ReferenceTotals> reference;

  // Nothing is wrong with the ticks that were run.
  [[nodiscard]] bool ok() const noexcept { return error.empty() && failures.empty(); }
  // The recording was run to its end.
  [[nodiscard]] bool is_whole() const noexcept { return !stopped && damage.empty(); }
  // Everything that went wrong or is worth knowing, a line each.
  [[nodiscard]] std::string text() const;
};

// The same recording and cell give the same ticks, bit for bit. If the recording was made with this
// cell and the daemon changed it while it ran, the replay changes it at the same ticks, to the
// cells that the recording keeps. `recording` is one of Clearance's own, a bag of ROS 2, or a CSV
// file of joint positions. A bag is MCAP, SQLite 3, or the folder of either. The CSV has t_ns and
// one column per joint.
[[nodiscard]] OfflineReplay replay_offline(
    const Cell& cell, const std::filesystem::path& recording,
    const OfflineReplayOptions& options = {},
    const std::function<void(const ReplayedTick&)>& on_tick = {});

}  // namespace clearance
