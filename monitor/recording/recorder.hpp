// Records a running daemon: the catalogue of each scene that comes into force, and for every tick
// the batches that it used, then its report and the zones that it changed. An offline replay of the
// file gives the same reports again.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/report.hpp"
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

  // Another cell is in force: everything after this call is of its scene. Writes its catalogue and
  // the files that it needs.
  void change(const Cell& cell, const SceneInForce& since);

  // A batch that a tick used, of poses or of joints, in the order of use; written in front of that
  // tick's report. It may be made for one of the last scenes (SceneIds).
  void poses(const PoseBatch& batch);

  // The report of a tick and what it used, which poses() has been given before. `publish_ns`: when
  // it was handed over; 0 where it was not published.
  void report(const Report& report, std::span<const SourceUse> sources,
              std::int64_t publish_ns = 0);

  void health(const clearance_msg_Health& health);

  // McapWriter::check, to be called now and then while nothing is written.
  bool check() { return writer_.check(); }

  // True when everything is in the file.
  bool close();
  [[nodiscard]] bool ok() const noexcept { return writer_.ok(); }
  [[nodiscard]] const std::string& error() const noexcept { return writer_.error(); }
  [[nodiscard]] std::uint64_t messages() const noexcept { return writer_.messages(); }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return writer_.bytes(); }
  // The reason why the recording does not hold the files that the last cell names. Empty: it holds
  // them, or there are none.
  [[nodiscard]] const std::string& without_files() const noexcept { return without_files_; }
  // The file that is written, and how many there are by now.
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return writer_.file(); }
  [[nodiscard]] std::uint64_t files() const noexcept { return writer_.part(); }

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
  struct Waiting {  // a batch whose report has not come yet
    TopicKind kind;
    SourceName source;
    std::uint64_t sequence_number;
    std::int64_t stamp_ns;
    std::vector<std::byte> cdr;
  };

  void note_joint_names(const Scene& scene);
  [[nodiscard]] std::span<const std::string> joint_names(std::uint64_t revision) const;
  void write_used(std::span<const SourceUse> sources, std::int64_t log_ns);
  void write_waiting(std::size_t count, std::int64_t log_ns);
  void write_separation(const Report& report, std::int64_t publish_ns);
  void write_zones(const Report& report);

  RecordingOptions options_;
  RecordingWriter writer_;
  std::string without_files_;
  std::vector<Waiting> waiting_;
  Sample<clearance_msg_PoseBatch> batch_;
  std::unique_ptr<OfScene> now_;
  std::deque<JointNamesOf> joint_names_;  // of the last scenes, the present one last
  CdrEncoder encoder_;
  std::int64_t last_ns_;
};

}  // namespace clearance
