// Publishes reports on DDS: a thread of its own converts and writes the reports that the tick
// thread queued.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <thread>

#include "config/cell/cell.hpp"
#include "monitor/dds/daemon_identity.hpp"
#include "monitor/dds/other_daemons.hpp"
#include "monitor/dds/partner_port.hpp"
#include "monitor/dds/pose_reader.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/loop/report_queue.hpp"
#include "monitor/loop/response_times.hpp"
#include "monitor/participant/participant.hpp"
#include "monitor/publish/contact_log.hpp"
#include "monitor/publish/health.hpp"
#include "monitor/publish/health_log.hpp"
#include "monitor/publish/metrics_text.hpp"
#include "monitor/publish/zone_writer.hpp"
#include "monitor/wire/changed_pairs.hpp"
#include "monitor/wire/convert.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/gradient_message.hpp"

namespace clearance {

// After this time without a report, clients treat the daemon as dead. It is 10 periods and at least
// 100 ms, so that neither a lost datagram nor a busy machine has this effect.
[[nodiscard]] std::int64_t lease_ns(double rate_hz) noexcept;

// Gets what is published, in the thread that writes.
class PublishedSamples {
 public:
  virtual ~PublishedSamples() = default;
  // `sample` has the type of the topic and is valid during the call.
  virtual void published(TopicKind kind, const void* sample) = 0;
  // Everything of one tick is published.
  virtual void report_ended() = 0;
};

// The only thread that writes to DDS. A report that cannot be written is counted and left out; the
// tick thread never waits for DDS.
class ReportWriter {
 public:
  // Is called once per second, in the thread that writes. May be empty.
  using OnHealth = std::function<void(const MetricsSource&)>;

  // Publishes the catalogue at once. Everything given must outlive this. `also` may be null, and so
  // may `partner`: the port of a daemon that has one, which `identity` names.
  ReportWriter(const Cell& cell, Participant& participant, ReportQueue& queue,
               const PoseReader& poses, const RecordingHealth& recording, OnHealth on_health = {},
               PublishedSamples* also = nullptr, DaemonIdentity identity = make_identity(),
               PartnerPort* partner = nullptr);
  ~ReportWriter();  // finishes

  // The cell has changed: closes the present queue. Once that is empty, the catalogue of this cell
  // and the reports of this queue follow. Both must outlive this. The topics have the same names.
  void continue_with(const Cell& cell, const SceneInForce& since, ReportQueue& queue);
  // True while the queue before is not empty yet after continue_with().
  [[nodiscard]] bool is_to_continue() const;

  // After the last tick: writes the queue.
  void finish();

  // This daemon, as in all its messages.
  [[nodiscard]] std::uint64_t daemon() const noexcept { return identity_.id; }
  // The number of clients that read distances now.
  [[nodiscard]] std::uint32_t distance_readers() const;
  [[nodiscard]] std::uint64_t failed_writes() const noexcept { return failed_writes_.load(); }
  // The cycle of the last report that was published, or left to the partner; 0: none yet.
  [[nodiscard]] std::uint64_t published_cycle() const noexcept { return published_.load(); }
  [[nodiscard]] const ResponseTimes& responses() const noexcept { return responses_; }
  // Before finish(): the thread that writes.
  [[nodiscard]] std::thread::native_handle_type thread() { return thread_.native_handle(); }
  // True if an older daemon publishes this cell. This one then writes nothing more.
  [[nodiscard]] bool yields() const noexcept { return others_.yields(); }

 private:
  // The parts that a change of the cell replaces, and the queue of the cell's reports.
  struct CellMessages {
    const Cell& cell;
    SceneInForce since;
    ReportQueue& queue;
    Sample<clearance_msg_Distances> distances;
    Sample<clearance_msg_Separation> separation;
    GradientMessage gradients;
    MapPairs pairs;  // to the ids of the whole cell
    ChangedPairs changed;
    std::int64_t period_ns;

    CellMessages(const Cell& the_cell, const SceneInForce& in_force, ReportQueue& the_queue,
                 std::uint64_t daemon);
  };

  void run();
  void write_all();
  [[nodiscard]] bool change();
  void open_topics(const Scene& scene);
  [[nodiscard]] Sample<clearance_msg_Catalogue> own_catalogue() const;
  void look_for_others();
  void tell_again();
  void write_report(const QueuedReport& queued);
  void note_delay(const QueuedReport& queued, bool published);
  [[nodiscard]] bool write_distances(const QueuedReport& queued, const TickTag& tag);
  void note_standing(PartnerStanding standing);
  [[nodiscard]] bool leads_now() const;
  void settle_catalogue();
  void write_separation(const Report& report);
  void write_health(const LoopStatistics& statistics);
  // Seals a message of the tick, and writes it.
  template <class Message>
  bool send(TopicKind kind, dds_entity_t writer, Message& message, const char* what);
  bool write(TopicKind kind, dds_entity_t writer, const void* sample, const char* what);

  Participant& participant_;
  const Topics topics_;
  const PoseReader& poses_;
  const RecordingHealth& recording_;
  const OnHealth on_health_;
  PublishedSamples* const also_;
  const DaemonIdentity identity_;
  PartnerPort* const partner_;
  dds_entity_t distances_, catalogue_, health_;
  dds_entity_t separation_ = 0;  // 0: no zone has had one yet
  dds_entity_t gradients_ = 0;   // 0: no scene has asked for them yet
  OtherDaemons others_;
  std::unique_ptr<CellMessages> now_;
  ZoneWriter zones_;
  ContactLog contact_log_;
  HealthLog health_log_;
  bool leads_ = true;  // writes what has one leader
  bool catalogue_is_due_ = false, takes_catalogue_back_ = false;
  std::int64_t refused_ns_ = 0;       // the last time that DDS did not take the catalogue
  std::int64_t active_again_ns_ = 0;  // the last time that active zones were due again
  std::uint64_t dropped_before_ = 0;  // by queues of former cells
  ResponseTimes responses_;
  std::atomic<std::uint64_t> failed_writes_{0};
  std::atomic<std::uint64_t> published_{0};
  mutable Mutex mutex_;
  GUARDED_BY(mutex_) std::unique_ptr<CellMessages> next_;  // null: no other cell follows
  GUARDED_BY(mutex_) ReportQueue* queue_;                  // the last one
  GUARDED_BY(mutex_) const ReportQueue* written_;          // the one that is being written
  std::thread thread_;
};

}  // namespace clearance
