// Reads the messages of a ROS 2 topic one by one, as C structs.
#pragma once

#include <string>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "tests/shared/loopback.hpp"
#include "tests/shared/take_next.hpp"

namespace clearance::test {

template <class T>
class RosReader {
 public:
  // `topic` is the name on DDS: "rt/diagnostics".
  RosReader(Participant& participant, const RosType& type, const std::string& topic)
      : reader_(participant.ros_reader(type, topic)) {}
  [[nodiscard]] dds_entity_t handle() const { return reader_; }
  // Takes the next message if there is one.
  bool take() { return take_next(reader_, sample_); }
  // Waits for the next message. Returns null if none comes.
  const T* next() {
    return eventually([this] { return take(); }) ? &*sample_ : nullptr;
  }
  T& last() { return *sample_; }

 private:
  dds_entity_t reader_;
  Sample<T> sample_;
};

}  // namespace clearance::test
