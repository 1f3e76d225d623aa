// One offline replay from its outline to its result.
//
// Feeds each tick of the recording to a Monitor and passes the report to the comparison, the
// expectations and the reference. Each of these keeps its first failure. Failures are not thrown,
// so one run finds the first of each kind.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "monitor/replay/expectations.hpp"
#include "monitor/replay/moveit_changes.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/recorded_loop.hpp"
#include "monitor/replay/reference_check.hpp"
#include "monitor/replay/report_difference.hpp"
#include "monitor/replay/tick_feed.hpp"
#include "monitor/replay/zone_difference.hpp"

namespace clearance {

class ReplayRun {
 public:
  // History, feed, options and `moveit` must outlive this.
  ReplayRun(SceneHistory& history, TickFeed& feed, const OfflineReplayOptions& options,
            const RecordingOutline& outline, MoveItChanges* moveit = nullptr);

  // Call it once: the result is moved out.
  OfflineReplay run(const std::function<void(const ReplayedTick&)>& on_tick);

 private:
  void run_ticks(const std::function<void(const ReplayedTick&)>& on_tick);
  void judge_the_whole();
  [[nodiscard]] std::string refusal() const;
  void follow(const Scene& scene);
  void change_scene(const TickInput& input, const Report& report);
  void begin_tick(const TickInput& input);
  void end_tick(const TickInput& input, const Report& report,
                const std::function<void(const ReplayedTick&)>& on_tick);
  void compare(const TickInput& input, const Report& report, const char* missing);
  void compare_zones();
  void finish_reference();
  [[nodiscard]] std::string nothing_in_window();
  void note_counts();
  template <class... Arguments>
  void note(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    result_.notes.push_back(fmt::format(text, std::forward<Arguments>(arguments)...));
  }
  void show_progress();
  void fail(std::uint64_t cycle, std::int64_t now_ns, const std::string& what,
            const std::string& expectation = {});
  [[nodiscard]] TickNumber number(std::uint64_t cycle) const;
  [[nodiscard]] double seconds(std::int64_t now_ns) const {
    return static_cast<double>(now_ns - first_ns_) * 1e-9;
  }

  const Scene* scene_;  // of the last tick
  const OfflineReplayOptions& options_;
  bool has_reports_, has_zones_, some_without_pairs_;
  std::string other_build_;  // what to add where something differs
  const std::size_t changes_left_out_;
  TickFeed& feed_;
  RecordedLoop loop_;
  const MoveItChanges* moveit_;
  Expectations expectations_;
  std::optional<ReferenceCheck> reference_;
  ZoneDifference zones_;
  std::unique_ptr<ReportDifference> difference_;  // null: nothing is compared

  OfflineReplay result_;
  std::uint64_t ran_ = 0, not_comparable_ = 0;  // ticks; those that ran before the window, too
  std::int64_t first_ns_ = 0, last_ns_ = 0;     // of these
  bool differs_ = false;
  bool gap_noted_ = false;
  bool restarted_ = false, has_changed_ = false;
  std::uint64_t cycle_offset_ = 0;  // recorded less replayed
  std::uint64_t last_recorded_cycle_ = 0;
  // The progress that was reported last, 0 to 1; -1 before the first report.
  double shown_ = -1.0;
};

}  // namespace clearance
