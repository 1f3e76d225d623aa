// Records a running daemon: the catalogue of each scene that comes into force, and for every tick
// the batches that it used, then its report and the zones that it changed. An offline replay of the
// file gives the same reports again.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/recording/recorded_event.hpp"
#include "monitor/recording/sink.hpp"
#include "monitor/wire/gradient_message.hpp"
#include "monitor/wire/written_zones.hpp"

namespace clearance {

// Called from one thread, never the tick's: it converts, allocates and writes to disk. A message is
// in the file at most 200 ms after the call, so a crash can cost no more than that. After an error
// (a full disk, a file that was deleted) nothing more is written, and error() says why.
class Recorder {
 public:
  // Writes the catalogue. The cell must exist until the last report of its scene was recorded.
  Recorder(const std::filesystem::path& file, const Cell& cell, std::int64_t now_ns,
           const RecordingOptions& options = {.overwrite = false});

  // Another cell is in force, or a new monitor of the same one: everything after this call is of
  // its scene. Writes its catalogue and the files that it needs.
  void change(const Cell& cell, const SceneInForce& since);

  // A batch that a tick used, of poses or of joints, in the order of use; written in front of that
  // tick's report. It may be made for one of the last scenes (SceneIds).
  void poses(const PoseBatch& batch);

  // A frame of a sensor that the next report's tick was shown, or that no tick was; written in
  // front of that report.
  void frame(std::int64_t stamp_ns, std::span<const std::byte> cdr) {
    sides_.push_back({SideTopic::kFrames, stamp_ns, {cdr.begin(), cdr.end()}});
  }

  // The state of a partner (PartnerState) that the next report's tick goes on from; written in
  // front of that report. Empty: it is lost.
  void joined(std::span<const std::byte> cdr);

  // The report of a tick and what it used, which poses() has been given before. `publish_ns`: when
  // it was handed over; 0 where it was not published. `lineage`: of partners (monitor/loop); 0
  // of a daemon on its own.
  void report(const Report& report, std::span<const SourceUse> sources, std::int64_t publish_ns = 0,
              std::uint64_t lineage = 0);

  void health(const clearance_msg_Health& health);

  // With RecordingOptions::events: the next report is one to write a file around, for a reason
  // outside of its tick.
  void ask_for_file(RecordedEvent event) { asked_ = std::move(event); }

  // McapWriter::check, to be called now and then while nothing is written.
  bool check() { return sink_->check(); }

  // True when everything is in the file.
  bool close();
  [[nodiscard]] bool ok() const noexcept { return sink_->ok(); }
  [[nodiscard]] const std::string& error() const noexcept { return sink_->error(); }
  [[nodiscard]] std::uint64_t messages() const noexcept { return sink_->messages(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return sink_->bytes(); }
  // The reason why the recording does not hold the files that the last cell names. Empty: it holds
  // them, or there are none.
  [[nodiscard]] const std::string& without_files() const noexcept { return without_files_; }
  // The file that is written, or was last, and how many there are by now.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return sink_->file(); }
  [[nodiscard]] std::uint64_t files() const noexcept { return sink_->files(); }
  [[nodiscard]] std::uint64_t events() const noexcept { return sink_->events(); }

 private:
  // State that follows from the scene.
  struct OfScene {
    explicit OfScene(const Scene& the_scene);
    const Scene& scene;
    Sample<clearance_msg_Distances> distances;
    Sample<clearance_msg_Separation> separation;
    GradientMessage gradients;
    WrittenZones zones;
  };
  // Joint states are recorded by name, and batches have ids of a scene.
  struct JointNamesOf {
    std::uint64_t revision;
    std::vector<std::string> names;
  };
  struct WaitingSide {
    SideTopic topic;
    std::int64_t stamp_ns;
    std::vector<std::byte> cdr;
  };
  struct Waiting {  // a batch whose report has not come yet
    TopicKind kind;
    SourceName source;
    std::uint64_t sequence_number;
    std::int64_t stamp_ns;
    std::vector<std::byte> cdr;
    std::uint64_t of = 0;  // which objects or joints it is of
  };

  void note_joint_names(const Scene& scene);
  [[nodiscard]] std::span<const std::string> joint_names(std::uint64_t revision) const;
  [[nodiscard]] bool holds(TopicKind kind) const { return !options_.left_out.contains(kind); }
  template <class T>
  void write(TopicKind kind, std::int64_t log_ns, std::int64_t publish_ns, const T& sample,
             bool repeated = false) {
    if (holds(kind)) sink_->write(kind, log_ns, publish_ns, encoder_.encode(sample), repeated);
  }
  void begin_scene(const Cell& cell, const clearance_msg_Catalogue& catalogue);
  [[nodiscard]] std::optional<RecordedEvent> event_of(const Report& report);
  void write_report(const Report& report, std::span<const SourceUse> sources,
                    std::int64_t publish_ns, std::uint64_t lineage);
  [[nodiscard]] std::span<const SourceUse> thin_out(std::span<const SourceUse> sources,
                                                    bool is_kept);
  void write_used(std::span<const SourceUse> sources, std::int64_t log_ns);
  void write_waiting(std::size_t count, std::int64_t log_ns);
  void write_separation(const Report& report, std::int64_t publish_ns);
  void write_zones(const Report& report);

  RecordingOptions options_;
  std::unique_ptr<RecordingSink> sink_;
  std::string without_files_;
  std::vector<Waiting> waiting_;
  std::vector<WaitingSide> sides_;
  Sample<clearance_msg_PoseBatch> batch_;
  std::unique_ptr<OfScene> now_;
  std::deque<JointNamesOf> joint_names_;  // of the last scenes, the present one last
  CdrEncoder encoder_;
  std::int64_t last_ns_;
  EventWatch watch_;
  std::optional<RecordedEvent> asked_;
  bool states_all_zones_ = true;      // the next tick does
  std::vector<SourceUse> thin_uses_;  // since the last tick that was kept
};

}  // namespace clearance
