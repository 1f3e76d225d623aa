// The messages of a robot and its trackers. A message and its names are made once; a write sets the
// numbers only.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "monitor/client/client.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance::client {
namespace {

dds_entity_t make_writer(Connection& connection, TopicKind kind) {
  return connection.participant().writer(kind, connection.topics().*topic(kind).name);
}

template <std::size_t N>
void copy_source(std::string_view source, char (&out)[N]) {
  if (source.empty() || source.size() >= N) {
    throw std::invalid_argument(fmt::format(
        "the source '{}' has {} bytes; expected a name of 1 to {}", source, source.size(), N - 1));
  }
  std::copy(source.begin(), source.end(), out);
}

bool has_readers(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer, &status) == DDS_RETCODE_OK &&
         status.current_count > 0;
}

}  // namespace

JointWriter::JointWriter(Connection& connection, std::string_view source,
                         const std::vector<std::string>& names) {
  copy_source(source, message_->source);
  for (auto* numbers : {&message_->positions, &message_->velocities}) {
    reserve_sequence(*numbers, names.size());
  }
  reserve_sequence(message_->names, names.size());
  for (const std::string& name : names) {
    message_->names._buffer[message_->names._length++] = dds_string_dup(name.c_str());
  }
  writer_ = make_writer(connection, TopicKind::kJointStates);
}

JointWriter::~JointWriter() { dds_delete(writer_); }

bool JointWriter::write(std::span<const double> positions, std::span<const double> velocities,
                        std::int64_t stamp_ns, bool stopping) {
  const std::size_t names = message_->names._length;
  if (positions.size() != names || (!velocities.empty() && velocities.size() != names)) {
    throw std::invalid_argument(
        fmt::format("{} positions and {} velocities were given for {} joints", positions.size(),
                    velocities.size(), names));
  }
  ++message_->sequence_number;
  message_->stamp_ns = stamp_ns;
  message_->stopping = stopping;
  std::ranges::copy(positions, message_->positions._buffer);
  std::ranges::copy(velocities, message_->velocities._buffer);
  message_->positions._length = static_cast<std::uint32_t>(positions.size());
  message_->velocities._length = static_cast<std::uint32_t>(velocities.size());
  return dds_write(writer_, &*message_) == DDS_RETCODE_OK;
}

bool JointWriter::is_heard() const { return has_readers(writer_); }

PoseWriter::PoseWriter(Connection& connection, std::string_view source) {
  copy_source(source, message_.source);
  writer_ = make_writer(connection, TopicKind::kPoses);
}

PoseWriter::~PoseWriter() { dds_delete(writer_); }

// Cyclone only reads the caller's poses, so they are not copied.
bool PoseWriter::write(std::span<const clearance_msg_ObjectPose> poses,
                       std::uint64_t scene_revision) {
  if (poses.size() > clearance_msg_kMaxPoses) return false;
  ++message_.sequence_number;
  message_.scene_revision = scene_revision;
  message_.poses._buffer = const_cast<clearance_msg_ObjectPose*>(poses.data());
  message_.poses._length = message_.poses._maximum = static_cast<std::uint32_t>(poses.size());
  return dds_write(writer_, &message_) == DDS_RETCODE_OK;
}

bool PoseWriter::is_heard() const { return has_readers(writer_); }

}  // namespace clearance::client
