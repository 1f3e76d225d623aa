// The daemon as one object: the tick loop in a thread of its own, the DDS ports around it, and an
// optional recording.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/daemon/file_watch.hpp"
#include "monitor/daemon/moveit_port.hpp"
#include "monitor/daemon/partner_states.hpp"
#include "monitor/daemon/recording.hpp"
#include "monitor/daemon/share_scenes.hpp"
#include "monitor/daemon/trajectory_port.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/dds/report_writer.hpp"
#include "monitor/dds/request_port.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/questions/question_desk.hpp"
#include "monitor/ros/ros_messages.hpp"
#include "monitor/ros/ros_writer.hpp"
#include "monitor/scene_changes/scene_changer.hpp"
#include "monitor/scene_changes/scene_thread.hpp"
#include "monitor/service/service_manager.hpp"

namespace clearance {

struct DaemonOptions {
  DdsOptions dds;
  std::uint64_t max_ticks = 0;  // 0: until a signal comes
  int fifo_priority = 0;        // of the tick thread; the other threads get one less; 0: ordinary
  std::filesystem::path record_file;  // empty: no recording
  RecordingOptions recording = {.overwrite = false};
  std::optional<int> cpu;            // processor that the tick thread is pinned to
  std::int64_t ahead_ns = 0;         // TickLoopOptions::ahead_ns; no effect with a partner
  CommanderOptions commander;        // how commands and SIGHUP change the cell
  std::string partner;               // this daemon's name among partners; empty: it has none
  bool reload = false;               // read the cell again when its files have changed
  ReportWriter::OnHealth on_health;  // once a second; may be empty
  // Lists all mistakes of the cell file for a person. Called after SIGHUP found some; may be empty.
  std::function<void()> list_mistakes;
};

// The order of the members matters: ports and queues outlive the loop that uses them.
class Daemon : private CellParts {
 public:
  // Joins DDS and announces the catalogue. Throws DdsError, and RecordError when the
  // recording cannot be made.
  Daemon(const Cell& cell, const DaemonOptions& options);
  ~Daemon() override;
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Ticks until a signal comes, `max_ticks` are done, or an older daemon of this cell is found.
  // Then it writes everything that is queued.
  void run(StopSignal& signal);

  // True when the daemon ends because an older one publishes this cell.
  [[nodiscard]] bool gave_way() const noexcept { return reports_.gives_way(); }
  // After run(): a summary for a person.
  [[nodiscard]] std::string summary() const;
  // After run(): true when nothing was to be recorded, or when the file holds all of it.
  [[nodiscard]] bool recording_complete() const noexcept;
  // After run(): true when the recording thread still waits for the disk. The program must then end
  // without destroying this object.
  [[nodiscard]] bool recording_hangs() const noexcept;
  // After run(): true when a cell is still being read. The program must then end without destroying
  // this object and static ones.
  [[nodiscard]] bool still_reads() const noexcept { return still_reads_; }

  // Any thread while run() runs: the one entry for tasks, wherever they come from. Returns false if
  // too many wait.
  [[nodiscard]] bool put(SceneTask task);

 private:
  // The parts that a change of the cell replaces.
  struct OfCell {
    std::shared_ptr<const Cell> cell;
    std::unique_ptr<ReportQueue> queue;
    std::unique_ptr<RosWriter> ros;
  };
  [[nodiscard]] std::int64_t ahead_ns() const noexcept { return partner_ ? 0 : options_.ahead_ns; }
  // The parts of a daemon that has a partner.
  struct OfPartner {
    TickPartner ticks;
    PartnerPort port;
    OfPartner(const Cell& cell, Participant& participant, PoseReader& poses, Clock& clock,
              const DaemonIdentity& identity);
    ~OfPartner() { poses_.end_sharing(); }
    OfPartner(const OfPartner&) = delete;
    OfPartner& operator=(const OfPartner&) = delete;

   private:
    PoseReader& poses_;
  };
  [[nodiscard]] OfCell parts_of(std::shared_ptr<const Cell> cell);
  [[nodiscard]] CommandPort::Sharing share_commands();
  [[nodiscard]] PartnerPort::Actions partner_actions();
  void share_moveit();
  void stop_sharing();
  [[nodiscard]] RosWrites::Leads leads();
  void tick_thread(std::atomic<bool>& done);
  void raise_priorities();
  void end_requests();
  void read_again();
  [[nodiscard]] bool files_changed();
  void watch_files(const std::vector<std::filesystem::path>& files);
  bool note_change(const CommandResult& result);
  std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>& cell) override;
  void follow(const SceneInForce& since) noexcept override;
  void end(const LoopStatistics& figures) noexcept override;
  void abandon() override;

  DaemonOptions options_;
  std::string cell_file_;
  ServiceManager service_;
  FileWatch files_;
  bool wants_to_read_ = false;                                    // the queue was full
  std::mutex read_mutex_;                                         // guards the next one
  std::optional<std::vector<std::filesystem::path>> read_files_;  // of the cell that was read again
  Participant participant_;
  MoveItPort moveit_;
  PoseReader poses_;
  const DaemonIdentity identity_;
  SystemClock clock_;
  std::unique_ptr<OfPartner> partner_;  // null: it has none
  RecordingHealth recording_health_;
  OfCell now_, next_;
  std::uint64_t dropped_before_ = 0;  // reports, by queues of former cells
  MinimumSeen least_before_;          // of all former cells, and the cell that it is of
  std::shared_ptr<const Cell> least_cell_;
  RosMessages messages_;
  ReportWriter reports_;
  std::unique_ptr<Recording> recording_;
  std::unique_ptr<TickLoop> loop_;
  std::unique_ptr<SceneChanger> changer_;
  std::atomic<bool> loop_ended_{false};
  std::atomic<std::uint64_t> revision_;  // in force
  std::unique_ptr<SceneThread> scene_thread_;
  std::unique_ptr<PartnerStates> partner_states_;
  std::unique_ptr<ShareScenes> shares_;    // null: the cell has none, or no messages of MoveIt
  std::unique_ptr<CommandPort> commands_;  // null: the cell names no client
  std::unique_ptr<QuestionDesk> desk_;     // likewise, here and below
  std::unique_ptr<QuestionPort> questions_;
  std::unique_ptr<TrajectoryPort> trajectories_;
  bool still_reads_ = false;
  std::atomic<bool> stop_{false};
  double seconds_ = 0.0;
};

}  // namespace clearance
