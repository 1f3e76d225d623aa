// The daemon as one object: the tick loop in a thread of its own, the DDS ports around it, and an
// optional recording.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "config/cell/cell.hpp"
#include "monitor/app/intervention_log.hpp"
#include "monitor/app/stop_signal.hpp"
#include "monitor/daemon/cell_reload.hpp"
#include "monitor/daemon/client_ports.hpp"
#include "monitor/daemon/moveit_port.hpp"
#include "monitor/daemon/partner_states.hpp"
#include "monitor/daemon/recording.hpp"
#include "monitor/daemon/service_manager.hpp"
#include "monitor/daemon/share_scenes.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/inputs/simulated_time.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/loop/tick_loop.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/report_writer.hpp"
#include "monitor/publish/ros_messages.hpp"
#include "monitor/publish/ros_writer.hpp"
#include "monitor/requests/scene_changer.hpp"
#include "monitor/requests/scene_thread.hpp"

namespace clearance {

struct DaemonOptions {
  DdsOptions dds;
  std::uint64_t max_ticks = 0;  // 0: until a signal comes
  int fifo_priority = 0;        // of the tick thread; the other threads get one less; 0: ordinary
  std::filesystem::path record_file;  // empty: no recording
  RecordingOptions recording = {.overwrite = false};
  InterventionLog* interventions = nullptr;  // outlives the daemon; null: there is none
  std::vector<std::string> command_line;     // for that log
  std::optional<int> cpu;                    // processor that the tick thread is pinned to
  std::int64_t ahead_ns = 0;                 // TickLoopOptions::ahead_ns; no effect with a partner
  CommanderOptions commander;                // how commands and SIGHUP change the cell
  std::string partner;               // this daemon's name among partners; empty: it has none
  bool reload = false;               // read the cell again when its files have changed
  ReportWriter::OnHealth on_health;  // once per second; may be empty
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

  // Ticks until a signal comes, `max_ticks` are done, an older daemon of this cell is found, or the
  // self-test fails.
  // Then it writes everything that is queued.
  void run(StopSignal& signal);

  // True when the daemon ends because an older one publishes this cell.
  [[nodiscard]] bool yielded() const noexcept { return reports_.yields(); }
  // After run(): the self-test of the monitor has failed.
  [[nodiscard]] bool damaged() const noexcept;
  // After run(): a summary for a person.
  [[nodiscard]] std::string summary() const;
  // After run(): of wake-ups, ticks, reports and responses, as histograms_json() writes them.
  [[nodiscard]] std::string histograms() const;
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
  struct CellOutputs {
    std::shared_ptr<const Cell> cell;
    std::unique_ptr<ReportQueue> queue;
    std::unique_ptr<RosWriter> ros;
  };
  [[nodiscard]] std::int64_t ahead_ns() const noexcept { return partner_ ? 0 : options_.ahead_ns; }
  // The parts of a daemon that has a partner.
  struct Partnership {
    TickPartner ticks;
    PartnerPort port;
    Partnership(const Cell& cell, Participant& participant, PoseReader& poses, Clock& clock,
                const DaemonIdentity& identity);
    ~Partnership() { poses_.end_sharing(); }
    Partnership(const Partnership&) = delete;
    Partnership& operator=(const Partnership&) = delete;

   private:
    PoseReader& poses_;
  };
  [[nodiscard]] CellOutputs parts_of(std::shared_ptr<const Cell> cell);
  void share_states();
  [[nodiscard]] std::vector<ReportSink*> first_sinks();
  [[nodiscard]] CellReload::Actions reload_actions();
  [[nodiscard]] ClientPorts::Actions client_actions();
  [[nodiscard]] PartnerPort::Actions partner_actions();
  void share_scenes();
  void stop_sharing();
  [[nodiscard]] RosWrites::Leads leads();
  void tick_thread(std::atomic<bool>& done);
  void raise_priorities();
  void end_requests();
  [[nodiscard]] std::optional<std::string> followed() const;
  bool note_change(const CommandResult& result, const nlohmann::ordered_json& asked);
  void note_start() const;
  std::vector<ReportSink*> prepare(const std::shared_ptr<const Cell>& cell) override;
  void follow(const SceneInForce& since) noexcept override;
  void end(const LoopStatistics& figures) noexcept override;
  void abandon() override;

  DaemonOptions options_;
  ServiceManager service_;
  CellReload reload_;
  Participant participant_;
  std::unique_ptr<SimulatedTime> time_;  // null: that of this machine
  MoveItPort moveit_;
  std::shared_ptr<const Cell> heard_cell_;  // outlives the threads of `poses_`; null: the first one
  PoseReader poses_;
  const DaemonIdentity identity_;
  SystemClock clock_;
  std::unique_ptr<Partnership> partner_;  // null: it has none
  RecordingHealth recording_health_;
  CellOutputs now_, next_;
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
  std::unique_ptr<ShareScenes> shares_;  // null: the cell has none, or no messages of MoveIt
  std::unique_ptr<ClientPorts> clients_;
  bool still_reads_ = false;
  std::atomic<bool> stop_{false};
  double seconds_ = 0.0;
};

}  // namespace clearance
