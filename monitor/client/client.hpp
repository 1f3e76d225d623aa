// A client of the daemon: hears its reports and sends it joints and poses, with the QoS that both
// sides need.
//
// find_package(clearance COMPONENTS client), link clearance::client. Messages are the types of
// idl/clearance.idl as C has them (clearance_msg_Distances, ...); idl/README.md has every field and
// unit. Constructors throw DdsError; nothing else throws unless it says so. An object is for one
// thread at a time, and its connection outlives it.
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

// Where the daemon is: its domain, partition and network, as its first log lines say.
class Connection {
 public:
  // Without options: this machine's loopback, domain 0, the default partition.
  explicit Connection(const DdsOptions& options = {}, const Topics& topics = {});
  // Within a participant that the program has already, and keeps for longer than this.
  Connection(dds_entity_t participant, const std::string& partition, const Topics& topics = {});
  ~Connection();

  // "domain 7, partition demo, interface lo, ...", for messages to a person.
  [[nodiscard]] const std::string& where() const noexcept;
  [[nodiscard]] const Topics& topics() const noexcept { return topics_; }
  [[nodiscard]] Participant& participant() noexcept { return *participant_; }

 private:
  std::unique_ptr<Participant> participant_;
  Topics topics_;
};

struct StreamOptions {
  std::chrono::nanoseconds old_after = std::chrono::milliseconds(100);  // a ReportCheck's limit
  std::int32_t depth = 64;  // messages that may wait while the program does something else
};

// What the daemon says in every tick. Message: that of one of the types below.
template <class Message>
class Stream {
 public:
  explicit Stream(Connection& connection, const StreamOptions& options = {});
  ~Stream();

  // The next message in order, waited for as long as `timeout`. False: none came.
  bool next(std::chrono::nanoseconds timeout = {});
  // The same, but the newest of those that are there: for a controller.
  bool newest(std::chrono::nanoseconds timeout = {});

  // The last message that came; all zero before the first.
  [[nodiscard]] const Message& operator*() const noexcept { return *message_; }
  [[nodiscard]] const Message* operator->() const noexcept { return &*message_; }
  // Whether it is fresh, of the same daemon as the one before, and how many are missing between.
  [[nodiscard]] const ReportCheck& check() const noexcept { return check_; }

  // Daemons that tick: 0: it has died or hangs; more than one is a mistake.
  [[nodiscard]] std::uint32_t daemons() const;
  // No daemon is there any longer, not even one that hangs.
  [[nodiscard]] bool has_ended() const;

 private:
  bool take();

  dds_entity_t reader_;
  std::unique_ptr<DataWait> wait_;
  // Taken into the second: Cyclone clears a sample when a writer leaves.
  Sample<Message> message_, scratch_;
  ReportChecker checker_;
  ReportCheck check_;
};

using Reports = Stream<clearance_msg_Distances>;
using Gradients = Stream<clearance_msg_Gradients>;    // `gradients: true` in the cell
using Separation = Stream<clearance_msg_Separation>;  // zones with `separation`

// A published pair of a report; null: it is not published, or `pair` is none.
[[nodiscard]] const clearance_msg_PairDistance* find(const clearance_msg_Distances& report,
                                                     std::optional<std::uint32_t> pair);

// The names behind the ids, as of the last update().
class Catalogue {
 public:
  explicit Catalogue(Connection& connection);
  void update();

  // Null: none has come. Another daemon, or another cell, has another revision.
  [[nodiscard]] const clearance_msg_Catalogue* message() const noexcept {
    return known_ ? &*message_ : nullptr;
  }
  // Of its ids; 0: none has come.
  [[nodiscard]] std::uint64_t revision() const noexcept { return message_->scene_revision; }

  // Ids by name; the two objects of a pair in any order. None: there is no such object or pair, or
  // no catalogue yet.
  [[nodiscard]] std::optional<std::uint32_t> object(std::string_view name) const;
  [[nodiscard]] std::optional<std::uint32_t> pair(std::string_view a, std::string_view b) const;
  [[nodiscard]] std::optional<std::uint32_t> joint(std::string_view name) const;

  // Names by id, "object 7" for an unknown one; of a pair those of the closest parts as well:
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

// How the daemon is doing, as of the last update(): once a second.
class Health {
 public:
  explicit Health(Connection& connection);
  void update();
  // Null: none has come.
  [[nodiscard]] const clearance_msg_Health* message() const noexcept {
    return known_ ? &*message_ : nullptr;
  }

 private:
  dds_entity_t reader_;
  Sample<clearance_msg_Health> message_, scratch_;
  bool known_ = false;
};

// The state of every zone by its id, as of the last update().
class Zones {
 public:
  explicit Zones(Connection& connection);
  void update();
  // Forgets what other daemons have said.
  void keep_only(std::uint64_t daemon);
  [[nodiscard]] const std::map<std::uint32_t, clearance_msg_ZoneState>& states() const noexcept {
    return states_;
  }

 private:
  dds_entity_t reader_;
  std::map<std::uint32_t, clearance_msg_ZoneState> states_;
};

// CLOCK_REALTIME, as stamps are.
[[nodiscard]] std::int64_t now_ns() noexcept;

// Sends joint states of robots that the cell names. `source`: 1 to 32 bytes, for no other writer.
class JointWriter {
 public:
  // `names`: as in the URDF, with the prefix that the cell gives. Throws std::invalid_argument when
  // the source's name does not fit, as PoseWriter does.
  JointWriter(Connection& connection, std::string_view source,
              const std::vector<std::string>& names);
  ~JointWriter();
  JointWriter(const JointWriter&) = delete;
  JointWriter& operator=(const JointWriter&) = delete;

  // Positions (rad or m) in the order of the names, and velocities (per second) or none, as they
  // were at `stamp_ns`. False: DDS did not take them. Throws std::invalid_argument when there are
  // more or fewer than names.
  bool write(std::span<const double> positions, std::span<const double> velocities = {},
             std::int64_t stamp_ns = now_ns());
  // Whether somebody listens.
  [[nodiscard]] bool is_heard() const;

 private:
  dds_entity_t writer_;
  Sample<clearance_msg_JointStates> message_;
};

// Sends poses of objects: all that one source knows at an instant.
class PoseWriter {
 public:
  PoseWriter(Connection& connection, std::string_view source);
  ~PoseWriter();
  PoseWriter(const PoseWriter&) = delete;
  PoseWriter& operator=(const PoseWriter&) = delete;

  // `scene_revision`: of the catalogue that the objects' ids are from; 0 is not checked. False: DDS
  // did not take them, or there are more than clearance_msg_kMaxPoses.
  bool write(std::span<const clearance_msg_ObjectPose> poses, std::uint64_t scene_revision);
  [[nodiscard]] bool is_heard() const;

 private:
  dds_entity_t writer_;
  clearance_msg_PoseBatch message_{};  // its poses are the caller's
};

}  // namespace client
}  // namespace clearance
