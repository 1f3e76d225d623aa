// The part of Cyclone DDS that is used here: a participant of one domain and partition, and its
// endpoints.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "monitor/participant/dds_options.hpp"
#include "monitor/participant/ros_node.hpp"
#include "monitor/wire/ros_types.hpp"
#include "monitor/wire/topics.hpp"

namespace clearance {

// Returns a handle or count; throws DdsError when it is negative.
dds_entity_t check_dds(dds_entity_t code, const std::string& attempted);

// Options of a writer that the table of topics does not contain.
struct WriterOptions {
  // Every write also asserts that the writer is alive. After this time without a write, readers
  // learn that it is not. With 0, it counts as alive while its participant does. Cyclone gives a
  // silent participant up after 10 s.
  std::int64_t lease_ns = 0;
  // If lease_ns is 0: Cyclone asserts it while the process runs, and readers learn within this time
  // that the process was killed. With 0, as above.
  std::int64_t process_lease_ns = 0;
  std::string user_data = {};                // USER_DATA, which every discovering program can read
  const dds_listener_t* listener = nullptr;  // may be null; it is copied
};

// A writer as discovery knows it.
struct WriterFacts {
  bool present = false;  // it still matches the reader
  std::string guid = {}, user_data = {};
};

// The writer behind a sample's publication handle.
[[nodiscard]] WriterFacts writer_facts(dds_entity_t reader, dds_instance_handle_t writer);
// The publication handles of all writers that match.
[[nodiscard]] std::vector<std::uint64_t> writers_of(dds_entity_t reader);
// The number of matching writers, and the number of those that wrote within their leases.
[[nodiscard]] std::uint32_t writers_there(dds_entity_t reader);
[[nodiscard]] std::uint32_t writers_alive(dds_entity_t reader);

// A sentence that says why the last writer that did not match this reader is not heard, with topic
// and cause. It is empty if there was none. Different partitions are no cause, because they are
// intended.
[[nodiscard]] std::string why_unheard(dds_entity_t reader);

// Owns the domain's configuration, the participant and all endpoints made through it.
class Participant {
 public:
  // With a name and in the default partition, the participant becomes a node of ROS 2 with its
  // first endpoint of a topic of ROS 2, unless why_no_ros_node() has a reason.
  explicit Participant(const DdsOptions& options, const std::string& ros_node = {});
  // Makes endpoints in a participant that its owner deletes after this.
  Participant(dds_entity_t participant, const std::string& partition);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  // Makes endpoints of a topic under the given name, with the QoS of the topic table. `depth`: the
  // number of samples of a key that may wait for a late reader; 0: the table's, which latched
  // topics always have. `listener` and `filter` may be null; both are copied.
  dds_entity_t reader(TopicKind kind, const std::string& name, std::int32_t depth = 0,
                      const dds_listener_t* listener = nullptr,
                      const dds_topic_filter* filter = nullptr);
  dds_entity_t writer(TopicKind kind, const std::string& name, const WriterOptions& options = {});
  // Reads a latched topic that several programs write, so that no writer's sample takes the place
  // of another's.
  dds_entity_t reader_of_several(TopicKind kind, const std::string& name);
  // Reads a distances topic without the writers of this participant: best-effort, only the newest
  // sample.
  dds_entity_t reader_of_others(const std::string& name, const dds_listener_t* listener);
  // Reads a topic without the writers of this participant, with the QoS of the topic table.
  dds_entity_t partner_reader(TopicKind kind, const std::string& name);
  // Makes endpoints of a ROS 2 topic, "rt/joint_states", in the partition of all other endpoints;
  // ROS 2 uses the default one only. A reader of a topic that is not latched is best-effort: it
  // matches every writer.
  dds_entity_t ros_reader(const RosType& type, const std::string& name,
                          const dds_listener_t* listener = nullptr);
  dds_entity_t ros_writer(const RosType& type, const std::string& name);
  [[nodiscard]] dds_entity_t handle() const noexcept { return participant_; }
  [[nodiscard]] const std::string& partition() const noexcept { return partition_; }
  // A number of this domain, this partition and a topic, as the messages of a tick state it.
  [[nodiscard]] std::uint64_t address(const std::string& topic) const noexcept;
  // "domain 7, partition demo, interface lo, datagrams of up to 65000 B, with DDS Security"
  [[nodiscard]] const std::string& where() const noexcept { return where_; }
  // Says how to start another program on the same network: the CYCLONEDDS_URI to copy.
  [[nodiscard]] const std::string& how_to_reach() const noexcept { return how_to_reach_; }

 private:
  void make_publisher_and_subscriber(const std::string& partition);
  dds_entity_t make_ros_writer(const RosType& type, const std::string& name);
  dds_entity_t make_topic(const dds_topic_descriptor_t& type, const std::string& name);

  bool is_own_ = true;
  dds_domainid_t domain_id_ = 0;
  std::string partition_, where_, how_to_reach_;
  struct OpenDomain;
  static std::shared_ptr<const OpenDomain> open_domain(const DdsOptions& options, std::uint32_t id);
  std::shared_ptr<const OpenDomain> domain_;  // shared by the participants of this process
  dds_entity_t participant_ = 0, publisher_ = 0, subscriber_ = 0;
  std::unique_ptr<RosNode> node_;
};

// Wakes one thread when a reader has samples, or when another thread calls wake().
class DataWait {
 public:
  DataWait(const Participant& participant, const std::vector<dds_entity_t>& readers);
  ~DataWait();
  DataWait(const DataWait&) = delete;
  DataWait& operator=(const DataWait&) = delete;
  // Any reader may be added, by the thread that waits.
  void add(dds_entity_t reader);
  // Returns true if samples may be waiting, false after wake() or the timeout.
  bool wait(std::int64_t timeout_ns);
  void wake() noexcept;

 private:
  dds_entity_t waitset_, guard_;
};

}  // namespace clearance
