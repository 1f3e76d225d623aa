// Configures the domain in the process instead of by a file, creates the participant, and gives
// every endpoint the QoS of the topic table. Every call is checked; a failure is a DdsError that
// names the attempt.
#include "monitor/participant/participant.hpp"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "monitor/interface/mutex.hpp"
#include "monitor/participant/domain_configuration.hpp"
#include "monitor/wire/report_checksum.hpp"

#if defined(__SANITIZE_THREAD__)
// The packaged Cyclone is built without ThreadSanitizer, which therefore sees its locks but not its
// atomic operations. Reports from inside the library mean nothing; reports in our code are not
// affected.
extern "C" const char* __tsan_default_suppressions() { return "race:libddsc.so\n"; }
#endif

namespace clearance {
namespace {

// A stopped reader must not delay a writer: keep-last drops the oldest sample instead of waiting. A
// full send buffer could still delay it; this limit ends that wait.
constexpr dds_duration_t kMaxBlocking = DDS_MSECS(10);

// Frees a QoS object, which only Cyclone can do.
struct QosDeleter {
  void operator()(dds_qos_t* qos) const noexcept { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, QosDeleter>;

// An empty name means the default partition, for which the policy is absent.
Qos partition_qos(const std::string& partition) {
  Qos qos(dds_create_qos());
  if (!partition.empty()) dds_qset_partition1(qos.get(), partition.c_str());
  return qos;
}

// USER_DATA of our own topics, which have no type hash: ROS 2 cannot read their types. A node on
// rmw_cyclonedds warns of each endpoint without USER_DATA, and of none that has some without a
// hash.
constexpr std::string_view kByClearance = "by=clearance;";

void set_user_data(const Qos& qos, std::string_view text) {
  dds_qset_userdata(qos.get(), text.data(), text.size());
}

Qos own_qos() {
  Qos qos(dds_create_qos());
  set_user_data(qos, kByClearance);
  return qos;
}

// Readers and writers get the same QoS, so that both sides of a topic always match.
Qos endpoint_qos(Delivery delivery, std::int32_t depth) {
  Qos qos = own_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking);
  dds_qset_durability(qos.get(), delivery == Delivery::kLatched ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                                : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  // A writer that leaves takes nothing back: readers keep its samples.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  return qos;
}

// The QoS of ROS 2, with the USER_DATA that its tools look for.
Qos ros_qos(const RosType& type, bool reliable, std::int32_t depth) {
  Qos qos(dds_create_qos());
  dds_qset_reliability(qos.get(), reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       kMaxBlocking);
  dds_qset_durability(qos.get(),
                      type.is_latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  // By default, a late reader of a latched topic gets one sample, whatever the depth.
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  set_user_data(qos, type.user_data);
  return qos;
}

// Cyclone states DDS Security's settings only in its built-in topic of participants, which has this
// one from its creation on.
bool is_secured(dds_entity_t participant) {
  const dds_entity_t reader =
      check_dds(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
                "listing participants");
  dds_instance_handle_t own = 0;
  dds_get_instance_handle(participant, &own);
  void* sample = nullptr;
  dds_sample_info_t info{};
  bool secured = false;
  if (dds_read_instance(reader, &sample, &info, 1, 1, own) == 1) {
    char* governance = nullptr;
    secured = dds_qget_prop(static_cast<const dds_builtintopic_participant_t*>(sample)->qos,
                            "dds.sec.access.governance", &governance);
    dds_free(governance);
    dds_return_loan(reader, &sample, 1);
  }
  dds_delete(reader);
  return secured;
}

}  // namespace

WriterFacts writer_facts(dds_entity_t reader, dds_instance_handle_t writer) {
  dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader, writer);
  if (endpoint == nullptr) return {};
  WriterFacts facts{.present = true};
  for (const std::uint8_t byte : endpoint->key.v) facts.guid += fmt::format("{:02x}", byte);
  void* bytes = nullptr;
  std::size_t size = 0;
  if (dds_qget_userdata(endpoint->qos, &bytes, &size) && bytes != nullptr) {
    facts.user_data.assign(static_cast<const char*>(bytes), size);
    dds_free(bytes);
  }
  dds_builtintopic_free_endpoint(endpoint);
  return facts;
}

// Asks again with more space when there are more handles than fit.
std::vector<std::uint64_t> writers_of(dds_entity_t reader) {
  std::vector<std::uint64_t> writers(64);
  for (;;) {
    const dds_return_t count = check_dds(
        dds_get_matched_publications(reader, writers.data(), writers.size()), "listing writers");
    const bool all = static_cast<std::size_t>(count) <= writers.size();
    writers.resize(static_cast<std::size_t>(count));
    if (all) return writers;
  }
}

std::uint32_t writers_there(dds_entity_t reader) {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);
  return status.current_count;
}

std::uint32_t writers_alive(dds_entity_t reader) {
  dds_liveliness_changed_status_t status{};
  dds_get_liveliness_changed_status(reader, &status);
  return status.alive_count;
}

// Measured with Cyclone 0.10.2: a writer whose @final type differs in any field is refused on both
// ends with policy 24, whichever end is older.
std::string why_unheard(dds_entity_t reader) {
  dds_requested_incompatible_qos_status_t status{};
  dds_get_requested_incompatible_qos_status(reader, &status);
  if (status.total_count == 0 || status.last_policy_id == DDS_PARTITION_QOS_POLICY_ID) return {};
  char topic[256] = "?";
  dds_get_name(dds_get_topic(reader), topic, sizeof topic);
  if (status.last_policy_id == DDS_TYPE_CONSISTENCY_ENFORCEMENT_QOS_POLICY_ID) {
    return fmt::format(
        "{} is published with another version of its type: rebuild this program with the IDL of "
        "that daemon",
        topic);
  }
  return fmt::format("{} is published with QoS that does not fit (policy {})", topic,
                     status.last_policy_id);
}

dds_entity_t check_dds(dds_entity_t code, const std::string& attempted) {
  if (code < 0) throw DdsError(attempted, code);
  return code;
}

struct Participant::OpenDomain {
  dds_entity_t handle;
  std::uint32_t number;  // in this process
};

// A process can configure a domain once: our participants share it, with the options of the first
// one. If another library of the process has configured it, theirs is left alone.
std::shared_ptr<const Participant::OpenDomain> Participant::open_domain(const DdsOptions& options,
                                                                        std::uint32_t id) {
  static Mutex mutex;
  GUARDED_BY(mutex) static std::map<std::uint32_t, std::weak_ptr<const OpenDomain>> domains;
  const Lock lock(mutex);
  if (auto open = domains[id].lock()) return open;
  std::uint32_t number = id;
  dds_entity_t handle = dds_create_domain(number, domain_configuration(options).c_str());
  if (handle == DDS_RETCODE_PRECONDITION_NOT_MET) {
    number = id + kSecondDomain;
    handle = dds_create_domain(number, second_domain_configuration(options, id).c_str());
  }
  check_dds(handle, fmt::format("configuring DDS domain {}", id));
  std::shared_ptr<const OpenDomain> domain(new OpenDomain{handle, number},
                                           [](const OpenDomain* open) {
                                             dds_delete(open->handle);
                                             delete open;
                                           });
  domains[id] = domain;
  return domain;
}

// Publisher and subscriber have the partition: endpoints of other partitions never match.
Participant::Participant(const DdsOptions& options, const std::string& ros_node) {
  const Domain domain = domain_of(options);
  where_ = where_joined(options, domain);
  how_to_reach_ = clearance::how_to_reach(options, domain.id);
  domain_ = open_domain(options, domain.id);
  if (domain_->number != domain.id)
    where_ += ", beside another library of this process that has configured this domain";
  participant_ = check_dds(dds_create_participant(domain_->number, nullptr, nullptr),
                           fmt::format("joining {}", where_));
  make_publisher_and_subscriber(options.partition);
  if (ros_node.empty() || !partition_.empty()) return;
  const std::string why_not = why_no_ros_node();
  if (why_not.empty()) {
    node_ = std::make_unique<RosNode>(participant_, ros_node, [this] {
      return make_ros_writer(kRosEntities, "ros_discovery_info");
    });
  } else if (interface_of(options).name == "ros") {
    how_to_reach_ += fmt::format("; it is not a node of ROS 2: {}", why_not);
  }
}

Participant::Participant(dds_entity_t participant, const std::string& partition)
    : is_own_(false),
      where_(fmt::format("a participant of the program's own, {}", describe_partition(partition))),
      participant_(participant) {
  make_publisher_and_subscriber(partition);
}

void Participant::make_publisher_and_subscriber(const std::string& partition) {
  partition_ = partition;
  if (is_secured(participant_)) where_ += ", with DDS Security";
  check_dds(dds_get_domainid(participant_, &domain_id_), "asking for the domain");
  domain_id_ = domain_on_the_wire(domain_id_);
  const Qos qos = partition_qos(partition);
  publisher_ =
      check_dds(dds_create_publisher(participant_, qos.get(), nullptr), "making a publisher");
  subscriber_ =
      check_dds(dds_create_subscriber(participant_, qos.get(), nullptr), "making a subscriber");
}

std::uint64_t Participant::address(const std::string& topic) const noexcept {
  return report_address(domain_id_, partition_, topic);
}

// Deletes readers and writers too. Topics are deleted with the participant, but only if it is our
// own.
Participant::~Participant() {
  if (is_own_) {
    dds_delete(participant_);
  } else {
    dds_delete(publisher_);
    dds_delete(subscriber_);
  }
}

// Cyclone shares topics of one name and type, so creating one twice is allowed.
dds_entity_t Participant::make_topic(const dds_topic_descriptor_t& type, const std::string& name) {
  return check_dds(dds_create_topic(participant_, &type, name.c_str(), nullptr, nullptr),
                   fmt::format("making topic {}", name));
}

// `depth` is ignored for latched topics, because a greater depth than the table's would not get a
// reader more. In Cyclone a filter belongs to the topic entity, so this reader has an entity of its
// own.
dds_entity_t Participant::reader(TopicKind kind, const std::string& name, std::int32_t depth,
                                 const dds_listener_t* listener, const dds_topic_filter* filter) {
  const Topic& row = topic(kind);
  const bool own_depth = depth > 0 && row.delivery == Delivery::kStream;
  const Qos qos = endpoint_qos(row.delivery, own_depth ? depth : row.reader_depth);
  const dds_entity_t of = make_topic(*row.type, name);
  if (filter != nullptr) check_dds(dds_set_topic_filter_extended(of, filter), "filtering a topic");
  return check_dds(dds_create_reader(subscriber_, of, qos.get(), listener),
                   fmt::format("making a reader of {}", name));
}

dds_entity_t Participant::reader_of_several(TopicKind kind, const std::string& name) {
  constexpr std::int32_t kSamples = 32;
  const Topic& row = topic(kind);
  const Qos qos = endpoint_qos(row.delivery, kSamples);
  return check_dds(dds_create_reader(subscriber_, make_topic(*row.type, name), qos.get(), nullptr),
                   fmt::format("making a reader of {}", name));
}

// A late joiner needs no history, and another sample follows a lost one.
dds_entity_t Participant::reader_of_others(const std::string& name,
                                           const dds_listener_t* listener) {
  const Qos qos = own_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  const dds_entity_t of = make_topic(*topic(TopicKind::kDistances).type, name);
  return check_dds(dds_create_reader(subscriber_, of, qos.get(), listener),
                   fmt::format("making a reader of {}", name));
}

dds_entity_t Participant::partner_reader(TopicKind kind, const std::string& name) {
  const Topic& row = topic(kind);
  const Qos qos = endpoint_qos(row.delivery, row.reader_depth);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return check_dds(dds_create_reader(subscriber_, make_topic(*row.type, name), qos.get(), nullptr),
                   fmt::format("making a reader of {}", name));
}

dds_entity_t Participant::ros_reader(const RosType& type, const std::string& name,
                                     const dds_listener_t* listener) {
  const Qos qos = ros_qos(type, type.is_reliable, type.depth);
  const dds_entity_t reader = check_dds(
      dds_create_reader(subscriber_, make_topic(*type.descriptor, name), qos.get(), listener),
      fmt::format("making a reader of {}", name));
  if (node_) node_->add_reader(reader);
  return reader;
}

dds_entity_t Participant::ros_writer(const RosType& type, const std::string& name) {
  const dds_entity_t writer = make_ros_writer(type, name);
  if (node_) node_->add_writer(writer);
  return writer;
}

dds_entity_t Participant::make_ros_writer(const RosType& type, const std::string& name) {
  const Qos qos = ros_qos(type, true, type.writer_depth);
  return check_dds(
      dds_create_writer(publisher_, make_topic(*type.descriptor, name), qos.get(), nullptr),
      fmt::format("making a writer of {}", name));
}

// Depth and durability are those of the table, whatever readers request.
dds_entity_t Participant::writer(TopicKind kind, const std::string& name,
                                 const WriterOptions& options) {
  const Topic& row = topic(kind);
  const Qos qos = endpoint_qos(row.delivery, row.writer_depth);
  if (options.lease_ns > 0) {
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_MANUAL_BY_TOPIC, options.lease_ns);
  } else if (options.process_lease_ns > 0) {
    dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, options.process_lease_ns);
  }
  if (!options.user_data.empty()) set_user_data(qos, options.user_data);
  return check_dds(
      dds_create_writer(publisher_, make_topic(*row.type, name), qos.get(), options.listener),
      fmt::format("making a writer of {}", name));
}

}  // namespace clearance
