// A client of the daemon: it receives reports and sends joints and poses, with the QoS that both
// sides need.
//
// Use find_package(clearance COMPONENTS client) and link clearance::client. Messages have the C
// types of idl/clearance.idl (clearance_msg_Distances, ...); idl/FIELDS.md documents every field
// and unit. Constructors throw DdsError; other functions throw only if they say so. An object is
// used by one thread at a time, and its connection outlives it.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "config/cell/topics.hpp"
#include "monitor/client/checked_reader.hpp"
#include "monitor/client/complete_reports.hpp"
#include "monitor/client/partner_merge.hpp"
#include "monitor/client/report_judge.hpp"
#include "monitor/participant/dds_options.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/report_check.hpp"

namespace clearance {

class DataWait;
class Participant;

namespace client {

// The daemon's domain, partition and network, as in its first log lines.
class Connection {
 public:
  // Without options, a connection uses the default partition, the domain of ROS_DOMAIN_ID or 0,
  // and loopback, or where ROS 2 is set up the network of its nodes.
  explicit Connection(const DdsOptions& options = {}, const Topics& topics = {});
  // Uses a participant that the program already has and that outlives this.
  Connection(dds_entity_t participant, const std::string& partition, const Topics& topics = {});
  ~Connection();

  // "domain 7, partition demo, interface lo, ...", for messages.
  [[nodiscard]] const std::string& where() const noexcept;
  [[nodiscard]] const Topics& topics() const noexcept { return topics_; }
  [[nodiscard]] Participant& participant() noexcept { return *participant_; }

 private:
  std::unique_ptr<Participant> participant_;
  Topics topics_;
};

struct StreamOptions {
  std::chrono::nanoseconds old_after = std::chrono::milliseconds(100);  // ReportChecker's limit
  std::int32_t depth = 64;  // messages that may wait while the program does other work
  // A good message counts for this time after it was published. 0: twice the period that it states.
  std::chrono::nanoseconds period{0};
  // Two faulty messages within this time hold fail_safe() until acknowledge().
  std::chrono::nanoseconds error_interval = std::chrono::hours(1);
};

// A topic that the daemon writes in every tick. `Message` is the message of one of the types below.
template <class Message>
class Stream {
 public:
  explicit Stream(Connection& connection, const StreamOptions& options = {});
  ~Stream();

  // Waits up to `timeout` for the next message in order. Returns false when none came.
  bool next(std::chrono::nanoseconds timeout = {});
  // Does the same with the newest waiting message: for a controller. partner() is then the worst
  // state of all that waited.
  bool newest(std::chrono::nanoseconds timeout = {});

  // The last message that came; all zero before the first one.
  [[nodiscard]] const Message& operator*() const noexcept { return *message_; }
  [[nodiscard]] const Message* operator->() const noexcept { return &*message_; }
  // Tells whether it is fresh, whether the daemon is the same, and how many reports are missing.
  [[nodiscard]] const ReportCheck& check() const noexcept { return check_; }
  // True while no message may be relied on, as reason() says (END_TO_END.md). Messages that are
  // corrupt, repeated or of another address are not handed out. Both functions count the time since
  // the last good message, so they may be called without a new one.
  [[nodiscard]] bool fail_safe() const noexcept { return reason() != ReportError::kGood; }
  [[nodiscard]] ReportError reason() const noexcept;
  // Two faulty messages came within the error interval, and fail_safe() stays until a person has
  // looked at it: acknowledge(). The next good message ends it then.
  [[nodiscard]] bool is_held() const noexcept { return judge_.is_held(); }
  void acknowledge() noexcept { judge_.acknowledge(); }
  // A copy of it says the same to another thread: its error() counts the time by monotonic_ns().
  [[nodiscard]] const ReportJudge& judge() const noexcept { return judge_; }
  // Takes the last message, in exchange for a sample that may be used again.
  void exchange(Sample<Message>& with) noexcept { std::swap(*message_, *with); }
  // For a wait on several streams.
  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }
  // Says whether two partners agree, whose reports are merged into one stream. A change
  // from one to the other is no other daemon for check().
  [[nodiscard]] const PartnerCheck& partner() const noexcept { return partner_; }
  // See PartnerMerge::senders(). The times are by monotonic_ns().
  [[nodiscard]] const std::array<PartnerMerge::Sender, 2>& senders() const noexcept {
    return merge_.senders();
  }

  // The number of daemons that tick. 0: the daemon has died or hangs; more than one is a mistake,
  // unless they are partners.
  [[nodiscard]] std::uint32_t daemons() const;
  // True if there is no daemon any longer, not even one that hangs.
  [[nodiscard]] bool has_ended() const;
  // A sentence for a person that says why an existing daemon cannot be heard. It was built with
  // another version of the message, or its QoS does not fit. Empty if no such daemon was met.
  [[nodiscard]] std::string refusal() const;

 private:
  bool take();

  dds_entity_t reader_;
  std::unique_ptr<DataWait> wait_;
  // Messages are read into scratch_ first. If a writer leaves, Cyclone clears the sample that it
  // reads into, and message_ must keep the last message.
  Sample<Message> message_, scratch_;
  ReportJudge judge_;
  ReportCheck check_;
  PartnerMerge merge_;  // of reports, here and below
  PartnerCheck partner_;
  CompleteReports whole_;
};

// Reports have all pairs here, even if the daemon publishes only those that changed. A pair that
// cannot be known, since a report before was missed, is unknown until it is listed again.
using Reports = Stream<clearance_msg_Distances>;
using Gradients = Stream<clearance_msg_Gradients>;    // `gradients: true` in the cell
using Separation = Stream<clearance_msg_Separation>;  // zones with `separation`

// Finds a published pair of a report; null when `pair` does not exist or is not published.
[[nodiscard]] const clearance_msg_PairDistance* find(const clearance_msg_Distances& report,
                                                     std::optional<std::uint32_t> pair);

// The names behind the ids, at the last update(). A daemon that changes its cell while it runs
// sends another catalogue, with another revision and other ids. The last kKept of them stay known,
// since reports of the cell before may still wait to be read.
class Catalogue {
 public:
  static constexpr std::size_t kKept = 9;

  explicit Catalogue(Connection& connection);
  // Calls `each` with every catalogue that has come, even if a later one replaces it at once.
  void update(const std::function<void(const clearance_msg_Catalogue&)>& each = {});

  // The latest one; null until one has come.
  [[nodiscard]] const clearance_msg_Catalogue* message() const noexcept {
    return kept_.empty() ? nullptr : &*kept_.front();
  }
  // The one that the ids of messages with this `scene_revision` belong to; null: it has not come.
  [[nodiscard]] const clearance_msg_Catalogue* message(std::uint64_t revision) const noexcept;
  // The revision of the latest one; 0 until one has come.
  [[nodiscard]] std::uint64_t revision() const noexcept {
    return kept_.empty() ? 0 : kept_.front()->scene_revision;
  }

  // Ids by name in the latest catalogue; a pair's objects may stand in any order. Nothing when
  // there is no such object or pair, or no catalogue yet. Object and Pair keep names through
  // changes.
  [[nodiscard]] std::optional<std::uint32_t> object(std::string_view name) const;
  [[nodiscard]] std::optional<std::uint32_t> pair(std::string_view a, std::string_view b) const;
  [[nodiscard]] std::optional<std::uint32_t> joint(std::string_view name) const;

  // Names by id, "object 7" for an unknown one. The name of a pair includes the closest parts:
  // "hand.finger - table". `revision` is that of the message with the id; without it, the id is of
  // the latest catalogue.
  [[nodiscard]] std::string object_name(std::uint32_t object,
                                        std::optional<std::uint64_t> revision = {}) const;
  [[nodiscard]] std::string pair_name(const clearance_msg_PairDistance& pair,
                                      std::optional<std::uint64_t> revision = {}) const;
  [[nodiscard]] std::string joint_name(std::uint32_t joint,
                                       std::optional<std::uint64_t> revision = {}) const;
  [[nodiscard]] const RefusedMessages& refused() const noexcept { return reader_.refused(); }

 private:
  [[nodiscard]] const clearance_msg_Catalogue* known(std::optional<std::uint64_t> revision) const;

  CheckedReader reader_;
  Sample<clearance_msg_Catalogue> scratch_;
  std::list<Sample<clearance_msg_Catalogue>> kept_;  // the latest one first
};

// An object by its name, whatever its id is at the time. The catalogue outlives it.
class Object {
 public:
  Object(Catalogue& catalogue, std::string name) : catalogue_(catalogue), name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  // Returns its id in messages with this `scene_revision`. Nothing: that scene lacks it, or its
  // catalogue has not come. Reads the catalogue when the revision is a new one.
  [[nodiscard]] std::optional<std::uint32_t> id(std::uint64_t revision);

 private:
  Catalogue& catalogue_;
  std::string name_;
  std::optional<std::uint64_t> revision_;  // that of `id_`
  std::optional<std::uint32_t> id_;
};

// A pair of objects by their names, in any order, whatever its id is at the time. The catalogue
// outlives it.
class Pair {
 public:
  Pair(Catalogue& catalogue, std::string a, std::string b)
      : catalogue_(catalogue), a_(std::move(a)), b_(std::move(b)) {}

  // The index of the pair in the scene of this revision, as Object::id() has that of the object.
  [[nodiscard]] std::optional<std::uint32_t> id(std::uint64_t revision);
  // The pair in this report; null when the report's scene has no such pair or does not publish it,
  // or when the catalogue of that scene has not come.
  [[nodiscard]] const clearance_msg_PairDistance* in(const clearance_msg_Distances& report) {
    return find(report, id(report.scene_revision));
  }
  // The same in a message of gradients.
  [[nodiscard]] const clearance_msg_PairGradient* in(const clearance_msg_Gradients& gradients);

 private:
  Catalogue& catalogue_;
  std::string a_, b_;
  std::optional<std::uint64_t> revision_;  // that of `id_`
  std::optional<std::uint32_t> id_;
};

// The daemon's health at the last update(); it comes once per second. Two partners have one
// health, that of the leader.
class Health {
 public:
  explicit Health(Connection& connection);
  void update();
  // Null until one has come.
  [[nodiscard]] const clearance_msg_Health* message() const noexcept {
    return known_ ? &*message_ : nullptr;
  }
  [[nodiscard]] const RefusedMessages& refused() const noexcept { return reader_.refused(); }

 private:
  CheckedReader reader_;
  Sample<clearance_msg_Health> message_, scratch_;
  std::int64_t leader_ns_ = 0;  // when the last one of a leader came
  bool known_ = false;
};

// The report lists a zone as active whose last state is not: the state is late, or was lost.
[[nodiscard]] bool is_raised(const clearance_msg_ZoneState& state,
                             const clearance_msg_Distances& report);
// Makes the state that of the report's tick: active, by a pair whose clearance is not known.
void raise(clearance_msg_ZoneState& state, const clearance_msg_Distances& report);

// The state of every zone by its id, at the last update(). Where several daemons that are there
// have written one, the state of the latest tick counts. That of a daemon that has gone stays until
// another one writes the zone.
class Zones {
 public:
  explicit Zones(Connection& connection);
  void update();
  // The same, and the zones that this report lists are active, although their states may come
  // later, or were lost. Figures of such a state are not known.
  void update(const clearance_msg_Distances& report);
  // Forgets the states that other daemons have sent: after a restart, ids may mean other zones. It
  // is not for partners, either of whom may have written a state.
  void keep_only(std::uint64_t daemon);
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& states() const noexcept {
    return states_;
  }
  [[nodiscard]] const RefusedMessages& refused() const noexcept { return reader_.refused(); }

 private:
  struct Written {
    clearance_msg_ZoneState state;
    dds_instance_handle_t writer;
  };
  void forget_gone();
  [[nodiscard]] static const clearance_msg_ZoneState& latest(
      const std::map<std::uint64_t, Written>& of_daemons);

  CheckedReader reader_;
  std::map<std::uint32_t, clearance_msg_ZoneState> states_;
  std::map<std::uint32_t, std::map<std::uint64_t, Written>> written_;  // by zone and daemon
  std::vector<std::uint32_t> raised_;  // those that only the last report says are active
};

// CLOCK_REALTIME, the clock of stamps.
[[nodiscard]] std::int64_t now_ns() noexcept;
// A clock that is never set, for waits. It does not go on from one start of the machine to the
// next.
[[nodiscard]] std::int64_t monotonic_ns() noexcept;

// Sends joint states of robots that the cell names. `source` has 1 to 32 bytes and must not belong
// to another writer.
class JointWriter {
 public:
  // `names` are those of the URDF, with the prefix that the cell gives. Throws
  // std::invalid_argument when the name of the source does not fit, as PoseWriter does.
  JointWriter(Connection& connection, std::string_view source,
              const std::vector<std::string>& names);
  ~JointWriter();
  JointWriter(const JointWriter&) = delete;
  JointWriter& operator=(const JointWriter&) = delete;

  // Sends positions (rad or m) in the order of the names, with velocities (per second) or none,
  // that held at `stamp_ns`. `stopping`: the brakes act, and do so until these joints stand.
  // Returns false when DDS did not take them. Throws std::invalid_argument when their number
  // differs from that of the names.
  bool write(std::span<const double> positions, std::span<const double> velocities = {},
             std::int64_t stamp_ns = now_ns(), bool stopping = false);
  // True when there is a reader.
  [[nodiscard]] bool is_heard() const;

 private:
  dds_entity_t writer_;
  Sample<clearance_msg_JointStates> message_;
};

// Sends poses of objects: all poses that one source knows at an instant.
class PoseWriter {
 public:
  PoseWriter(Connection& connection, std::string_view source);
  ~PoseWriter();
  PoseWriter(const PoseWriter&) = delete;
  PoseWriter& operator=(const PoseWriter&) = delete;

  // `scene_revision` is that of the catalogue with the objects' ids (Object::id). 0 is not checked,
  // and is refused after a change of the cell. Returns false when DDS did not take the poses, or
  // when there are more than clearance_msg_kMaxPoses.
  bool write(std::span<const clearance_msg_ObjectPose> poses, std::uint64_t scene_revision);
  [[nodiscard]] bool is_heard() const;

 private:
  dds_entity_t writer_;
  clearance_msg_PoseBatch message_{};  // its poses are the caller's
};

}  // namespace client
}  // namespace clearance
