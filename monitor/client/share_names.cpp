#include "monitor/client/share_names.hpp"

#include <dds/dds.h>

#include "config/cell/share_topics.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::client {

ShareNames::ShareNames(Connection& connection)
    : reader_(check_dds(dds_create_reader(connection.participant().handle(),
                                          DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
                        "making a reader of discovery")),
      beginning_(share_topic(connection.topics().distances, "")) {}

ShareNames::~ShareNames() { dds_delete(reader_); }

const std::set<std::string>& ShareNames::poll() {
  for (;;) {
    void* sample = nullptr;
    dds_sample_info_t info;
    const dds_return_t count = dds_take(reader_, &sample, &info, 1, 1);
    if (count <= 0) return names_;
    const std::string topic =
        info.valid_data ? static_cast<const dds_builtintopic_endpoint_t*>(sample)->topic_name : "";
    dds_return_loan(reader_, &sample, count);
    if (topic.starts_with(beginning_)) names_.insert(topic.substr(beginning_.size()));
  }
}

}  // namespace clearance::client
