// A client of the daemon: it receives reports and sends joints and poses, with the QoS that both
// sides need.
//
// Use find_package(clearance COMPONENTS client) and link clearance::client. Messages have the C
// types of idl/clearance.idl (clearance_msg_Distances, ...); idl/FIELDS.md documents every field
// and unit. Constructors throw DdsError; other functions throw only if they say so. An object is
// used by one thread at a time, and its connection outlives it.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell/topics.hpp"
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
  // Without options: this machine's loopback, domain 0, the default partition.
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
};

// A topic that the daemon writes in every tick. `Message` is the message of one of the types below.
template <class Message>
class Stream {
 public:
  explicit Stream(Connection& connection, const StreamOptions& options = {});
  ~Stream();

  // Waits up to `timeout` for the next message in order. Returns false when none came.
  bool next(std::chrono::nanoseconds timeout = {});
  // Does the same with the newest waiting message: for a controller.
  bool newest(std::chrono::nanoseconds timeout = {});

  // The last message that came; all zero before the first one.
  [[nodiscard]] const Message& operator*() const noexcept { return *message_; }
  [[nodiscard]] const Message* operator->() const noexcept { return &*message_; }
  // Tells whether it is fresh, whether the daemon is the same, and how many reports are missing.
  [[nodiscard]] const ReportCheck& check() const noexcept { return check_; }

  // The number of daemons that tick. 0: the daemon has died or hangs; more than one is a mistake.
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
  ReportChecker checker_;
  ReportCheck check_;
};

using Reports = Stream<clearance_msg_Distances>;
using Gradients = Stream<clearance_msg_Gradients>;    // `gradients: true` in the cell
using Separation = Stream<clearance_msg_Separation>;  // zones with `separation`

// Finds a published pair of a report; null when `pair` does not exist or is not published.
[[nodiscard]] const clearance_msg_PairDistance* find(const clearance_msg_Distances& report,
                                                     std::optional<std::uint32_t> pair);

// The names behind the ids, at the last update().
class Catalogue {
 public:
  explicit Catalogue(Connection& connection);
  void update();

  // Null until one has come. Another daemon or another cell has another revision.
  [[nodiscard]] const clearance_msg_Catalogue* message() const noexcept {
    return known_ ? &*message_ : nullptr;
  }
  // The revision that its ids belong to; 0 until one has come.
  [[nodiscard]] std::uint64_t revision() const noexcept { return message_->scene_revision; }

  // Ids by name; a pair's objects may stand in any order. Nothing when there is no such object or
  // pair, or no catalogue yet.
  [[nodiscard]] std::optional<std::uint32_t> object(std::string_view name) const;
  [[nodiscard]] std::optional<std::uint32_t> pair(std::string_view a, std::string_view b) const;
  [[nodiscard]] std::optional<std::uint32_t> joint(std::string_view name) const;

  // Names by id, "object 7" for an unknown one. The name of a pair includes the closest parts:
  // "hand.finger - table".
  [[nodiscard]] std::string object_name(std::uint32_t object) const;
  [[nodiscard]] std::string pair_name(const clearance_msg_PairDistance& pair) const;
  [[nodiscard]] std::string joint_name(std::uint32_t joint) const;

 private:
  [[nodiscard]] std::string part_name(std::uint32_t object, std::uint32_t part) const;

  dds_entity_t reader_;
  Sample<clearance_msg_Catalogue> message_, scratch_;
  bool known_ = false;
};

// The daemon's health at the last update(); it comes once a second.
class Health {
 public:
  explicit Health(Connection& connection);
  void update();
  // Null until one has come.
  [[nodiscard]] const clearance_msg_Health* message() const noexcept {
    return known_ ? &*message_ : nullptr;
  }

 private:
  dds_entity_t reader_;
  Sample<clearance_msg_Health> message_, scratch_;
  bool known_ = false;
};

// The state of every zone by its id, at the last update().
class Zones {
 public:
  explicit Zones(Connection& connection);
  void update();
  // Forgets the states that other daemons have sent.
  void keep_only(std::uint64_t daemon);
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& states() const noexcept {
    return states_;
  }

 private:
  dds_entity_t reader_;
  std::map<std::uint32_t, clearance_msg_ZoneState> states_;
};

// CLOCK_REALTIME, the clock of stamps.
[[nodiscard]] std::int64_t now_ns() noexcept;

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
  // that held at `stamp_ns`. Returns false when DDS did not take them. Throws std::invalid_argument
  // when their number differs from that of the names.
  bool write(std::span<const double> positions, std::span<const double> velocities = {},
             std::int64_t stamp_ns = now_ns());
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

  // `scene_revision` is that of the catalogue with the objects' ids; 0 is not checked. Returns
  // false when DDS did not take the poses, or when there are more than clearance_msg_kMaxPoses.
  bool write(std::span<const clearance_msg_ObjectPose> poses, std::uint64_t scene_revision);
  [[nodiscard]] bool is_heard() const;

 private:
  dds_entity_t writer_;
  clearance_msg_PoseBatch message_{};  // its poses are the caller's
};

}  // namespace client
}  // namespace clearance
