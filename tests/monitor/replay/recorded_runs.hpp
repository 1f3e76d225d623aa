// Recordings of a small cell, made as the daemon makes them: a monitor that ticks, and a recorder.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "monitor/recording/reader.hpp"
#include "monitor/recording/recorder.hpp"
#include "monitor/recording/writer.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

// A moving hand, a moving tool and a fixed box. The zone 'stop' covers all pairs.
inline Scene bench_cell() {
  Scene scene = cell_of({moving("hand", {ball(0.05)}), moving("tool", {capsule(0.2, 0.02)}),
                         fixed("box", {block(Vec3(0.1, 0.1, 0.1))}, at(0, 0, 0))});
  for (Object& object : scene.objects) object.max_speed = 2.0;
  scene.name = "bench";
  scene.revision = 41;
  scene.pairs[0].publish = scene.pairs[1].publish = true;
  scene.zones.push_back(zone_over(scene, 0.1, 0.15));
  scene.zones[0].name = "stop";
  return scene;
}

// The hand descends to `nearest` m above the box in the middle of the run and then rises.
inline Pose hand_at(int tick, int ticks, double nearest) {
  const double far = std::abs(tick - ticks / 2) / (0.5 * ticks);
  return at(0.0, 0.0, 0.1 + 0.05 + nearest + 0.4 * far);
}

struct Run {
  int ticks = 200;
  double nearest = 0.08;  // distance of hand and box, m
  std::uint64_t seed = 1;
};

// Source 'arm' sends the hand and source 'cell' the tool. Each sends zero, one or two batches per
// tick.
inline void record_run(const Cell& cell, const std::filesystem::path& file, const Run& run = {},
                       const RecordingOptions& options = {.overwrite = false}) {
  Monitor monitor(cell.scene);
  Recorder recorder(file, cell, kStart, options);
  Random random(run.seed);
  std::uint64_t sequence[2] = {0, 0};
  for (int tick = 0; tick < run.ticks; ++tick) {
    const std::int64_t now_ns = kStart + tick * kTick;
    std::vector<PoseSample> samples;
    std::vector<SourceUse> uses;
    for (std::uint32_t source = 0; source < 2; ++source) {
      const int batches = tick == 0 ? 1 : static_cast<int>(random.uniform(0.0, 3.0));
      for (int i = 0; i < batches; ++i) {
        PoseBatch batch{
            SourceName(source == 0 ? "arm" : "cell"), ++sequence[source], cell.scene.revision, {}};
        Pose pose = source == 0 ? hand_at(tick, run.ticks, run.nearest) : random.pose(0.01);
        if (source == 1) pose.position += Vec3(0.0, 1.0, 0.5);
        batch.samples.push_back(sample(source, pose, now_ns - 100'000 + i));
        samples.push_back(batch.samples.back());
        recorder.poses(batch);
        if (i == batches - 1) uses.push_back({batch.source, batch.sequence_number});
      }
    }
    recorder.report(monitor.tick(samples, now_ns), uses);
  }
  EXPECT_TRUE(recorder.close()) << recorder.error();
}

struct Kept {
  TopicKind kind;
  std::int64_t log_ns, publish_ns;
  std::vector<std::byte> cdr;
};

inline std::vector<Kept> messages_of(const std::filesystem::path& file) {
  RecordingReader reader(file);
  std::vector<Kept> all;
  RecordedMessage message;
  while (reader.next(message)) {
    all.push_back({message.kind,
                   message.log_ns,
                   message.publish_ns,
                   {message.cdr.begin(), message.cdr.end()}});
  }
  EXPECT_EQ("", reader.error());
  return all;
}

// Returns the message with its content changed.
template <class T>
Kept altered(const Kept& message, const std::function<void(T&)>& change) {
  Sample<T> sample;
  EXPECT_TRUE(CdrDecoder().decode(message.cdr, sample));
  change(*sample);
  CdrEncoder encoder;
  const auto cdr = encoder.encode(*sample);
  return {message.kind, message.log_ns, message.publish_ns, {cdr.begin(), cdr.end()}};
}

template <class T>
Sample<T> decoded(const Kept& message) {
  Sample<T> sample;
  EXPECT_TRUE(CdrDecoder().decode(message.cdr, sample));
  return sample;
}

// The same catalogue of a daemon of another build.
inline Sample<clearance_msg_Catalogue> catalogue_of_build(const Kept& message,
                                                          const std::string& build) {
  auto catalogue = decoded<clearance_msg_Catalogue>(message);
  dds_string_free(catalogue->build);
  catalogue->build = dds_string_dup(build.c_str());
  return catalogue;
}

// `build` names the build that made the reports; if it is empty, none is named. The first message
// is then a catalogue.
inline void write_messages(const std::filesystem::path& file, const std::vector<Kept>& messages,
                           const std::string& build = {}) {
  RecordingWriter writer(file, Topics{});
  if (!build.empty()) writer.describe(*catalogue_of_build(messages.front(), build));
  for (const Kept& message : messages) {
    writer.write(message.kind, message.log_ns, message.publish_ns,
                 std::span<const std::byte>(message.cdr));
  }
  EXPECT_TRUE(writer.close()) << writer.error();
}

}  // namespace clearance::test
