// The poses topic as a PoseSource: a thread of its own takes samples and hands them to the tick
// thread.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/scene.hpp"
#include "monitor/dds/participant.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/spsc_ring.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// What came from one source, since the start.
struct SourceTally {
  SourceName source;
  std::uint64_t batches = 0;    // handed to the tick
  std::uint64_t lost = 0;       // gaps in the sequence numbers, and batches with no slot free
  std::uint64_t cut_poses = 0;  // beyond what a batch of this cell can hold: not used
  std::uint64_t last_sequence = 0;
  std::int64_t last_ns = 0;  // when its last sample was taken, CLOCK_REALTIME
  bool warned_of_revision = false;
};

// A source beyond those that are heard.
struct RefusedSource {
  SourceName source;  // empty: all others together
  std::uint64_t poses = 0;
};

// next() is called by the tick thread and takes no lock; everything else by other threads.
class PoseReader final : public PoseSource {
 public:
  // Poses that one batch may hold; what a source sends beyond it is counted and not used.
  [[nodiscard]] static std::size_t samples_a_batch(const Scene& scene) noexcept;
  // Batches that may wait for one tick.
  static constexpr std::size_t kBatches = 128;
  // Samples of a source that may arrive while the taking thread is held up.
  static constexpr std::int32_t kDepth = topic(TopicKind::kPoses).reader_depth;

  // Starts the thread. Scene and participant must outlive this.
  PoseReader(const Scene& scene, Participant& participant);
  ~PoseReader() override;

  const PoseBatch* next() noexcept override;

  // Any thread but the tick's.
  [[nodiscard]] std::vector<SourceTally> tallies() const;
  [[nodiscard]] std::vector<RefusedSource> refused_sources() const;

 private:
  void run();
  void take_all();
  void hand_over(clearance_msg_PoseBatch& batch);
  SourceTally* tally_of(const SourceName& source);
  void refuse(const SourceName& source, std::uint64_t poses);

  const Scene& scene_;
  std::size_t samples_a_batch_;
  dds_entity_t reader_;
  DataWait wait_;
  std::array<Sample<clearance_msg_PoseBatch>, kDepth> taken_;
  SpscRing<PoseBatch> ring_;
  bool lent_ = false;  // the front slot is with the tick

  mutable std::mutex
      tallies_mutex_;  // between the taking and the publishing thread; never the tick's
  std::vector<SourceTally> tallies_;
  std::vector<RefusedSource> refused_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace clearance
