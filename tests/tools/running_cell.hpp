// The daemon as a client meets it: cell files, a source of poses, and a reader of distances.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/wire/convert.hpp"
#include "tests/shared/child_process.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance::test {

inline const std::string kDaemon = test::places::programs() + "/clearanced";
inline const std::string kRobot = test::places::programs() + "/clearance-robot";
inline const std::string kRecord = test::places::programs() + "/clearance-record";
inline const std::string kReplay = test::places::programs() + "/clearance-replay";
inline const std::string kScene = test::places::programs() + "/clearance-scene";
inline const std::string kWatch = test::places::programs() + "/clearance-watch";

// A cell in a temporary file of its own.
class CellFile {
 public:
  explicit CellFile(const std::string& text) {
    static int count = 0;
    path_ =
        "/tmp/clearance-cell-" + std::to_string(getpid()) + "-" + std::to_string(++count) + ".yaml";
    std::ofstream(path_) << text;
  }
  ~CellFile() { std::remove(path_.c_str()); }
  CellFile(const CellFile&) = delete;
  CellFile& operator=(const CellFile&) = delete;
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] Cell cell() const { return std::get<Cell>(read_cell(path_)); }

 private:
  std::string path_;
};

// Runs programs on files in a private folder.
class RunsPrograms : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder / name).string(); }
  // Returns the exit code. The program's output goes to `output`.
  int run(const std::string& program, const std::vector<std::string>& arguments) {
    ChildProcess child(program, arguments);
    const int status = child.wait();
    output = child.output();
    return status;
  }

  ScratchFolder folder;
  std::string output;
};

// Two boxes that swing above a floor, slowly enough for any machine and sanitizer.
inline std::string small_cell(const std::string& name, int age_limit_ms = 10'000) {
  return "name: " + name +
         R"(
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: )" +
         std::to_string(age_limit_ms) + R"(, max_speed: 5}
objects:
  - {name: left, groups: [arm], box: {size: [0.2, 0.2, 0.2]}}
  - {name: right, groups: [arm], box: {size: [0.2, 0.3, 0.2]}}
  - {name: floor, groups: [still], fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}
pairs:
  - {between: [arm, still], publish: true}
  - {between: [left, right], publish: true}
zones:
  - {name: near, between: [arm, arm], enter_below: 0.3, leave_above: 0.35}
simulation:
  movers:
    - {object: left, centre: {xyz: [-0.5, 0, 3]}, amplitude: [0.3, 0, 0.2], frequency_hz: 2}
    - {object: right, centre: {xyz: [0.5, 0, 3]}, amplitude: [0.1, 0.2, 0], frequency_hz: 3}
)";
}

inline std::vector<std::string> dds_arguments(const DdsOptions& dds) {
  return {"--domain", std::to_string(*dds.domain), "--partition", dds.partition};
}

inline std::vector<std::string> with(std::vector<std::string> first,
                                     const std::vector<std::string>& more) {
  first.insert(first.end(), more.begin(), more.end());
  return first;
}

// Sends the cell's simulated motion, one batch per call.
class Poses {
 public:
  Poses(Participant& participant, const Cell& cell, std::string_view source = "test")
      : scene_(cell.scene),
        simulation_(cell.simulation),
        source_(source),
        writer_(participant.writer(TopicKind::kPoses, cell.topics.poses)) {
    poses_at(simulation_, 0.0, poses_);
    sample_ = make_batch(poses_.size());
  }
  [[nodiscard]] dds_entity_t writer() const noexcept { return writer_; }

  // Translates everything by this vector from the positions in the cell, m.
  void move_by(const Vec3& shift) { moved_ = shift; }
  // Multiplies the twists of the motion by this factor.
  void scale_twists(double factor) { twist_factor_ = factor; }
  // Makes stamps come from a clock that is ahead by this time.
  void set_clock_ahead(std::int64_t ns) { clock_ahead_ns_ = ns; }

  // All batches sent so far, in order. Numbers count from 1.
  [[nodiscard]] const std::vector<PoseBatch>& sent() const noexcept { return sent_; }

  void send(double t_s, bool with_twist = true) {
    poses_at(simulation_, t_s, poses_);
    PoseBatch& batch = sent_.emplace_back();
    batch.source = source_;
    batch.sequence_number = sent_.size();
    batch.scene_revision = scene_.revision;
    const std::int64_t now = SystemClock().realtime_ns() + clock_ahead_ns_;
    for (const PoseAt& pose : poses_) {
      batch.samples.push_back({.object = pose.object,
                               .stamp_ns = now,
                               .world_from_object = {moved_ + pose.world_from_object.position,
                                                     pose.world_from_object.orientation},
                               .twist = {.linear = twist_factor_ * pose.twist.linear,
                                         .angular = twist_factor_ * pose.twist.angular},
                               .has_twist = with_twist});
    }
    to_wire(batch, *sample_);
    ASSERT_EQ(dds_write(writer_, &*sample_), DDS_RETCODE_OK);
  }

 private:
  const Scene& scene_;
  const Simulation& simulation_;
  SourceName source_;
  dds_entity_t writer_;
  std::vector<PoseAt> poses_;
  std::vector<PoseBatch> sent_;
  std::int64_t clock_ahead_ns_ = 0;
  Vec3 moved_ = Vec3::Zero();
  double twist_factor_ = 1.0;
  Sample<clearance_msg_PoseBatch> sample_;
};

// Waits until the daemon has met all writers that this participant has made. A writer knows only
// that it has met the daemon's reader: what it sends before that reader has met it, too, is lost. A
// daemon meets the writers of a participant in their order, and logs those of poses.
[[nodiscard]] inline bool meets_writers_of(Participant& participant, const ChildProcess& daemon) {
  const std::string topic = Topics{}.poses, line = "a writer of " + topic + " appeared";
  const auto appeared = [&] {
    const std::string log = daemon.output();
    std::size_t count = 0;
    for (auto at = log.find(line); at != std::string::npos; at = log.find(line, at + 1)) ++count;
    return count;
  };
  const std::size_t before = appeared();
  const dds_entity_t last = participant.writer(TopicKind::kPoses, topic);
  const bool is_met = eventually([&] { return appeared() > before; });
  dds_delete(last);
  return is_met;
}

// Reads distances as any client does.
class Distances {
 public:
  Distances(Participant& participant, const Cell& cell)
      : reader_(participant.reader(TopicKind::kDistances, cell.topics.distances, 8192)) {}
  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }

  // Waits for discovery: until both ends know each other, reports may be missing.
  void settle() {
    std::uint64_t cycle = 0;
    for (int in_a_row = 0; in_a_row < 5;) {
      const auto report = next();
      ASSERT_NE(report, nullptr);
      in_a_row = (*report)->cycle == cycle + 1 ? in_a_row + 1 : 0;
      cycle = (*report)->cycle;
    }
  }

  // Returns the next report, or null if none arrives.
  std::unique_ptr<Sample<clearance_msg_Distances>> next() {
    auto sample = std::make_unique<Sample<clearance_msg_Distances>>();
    const bool came = eventually([&] { return take_next(reader_, *sample); });
    return came ? std::move(sample) : nullptr;
  }

 private:
  dds_entity_t reader_;
};

}  // namespace clearance::test
