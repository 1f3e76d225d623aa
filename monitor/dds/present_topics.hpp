// The topics that other programs publish in our domain, of any type and partition, as DDS discovery
// reports them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "monitor/participant/participant.hpp"

namespace clearance {

// A writer of another participant.
struct PresentWriter {
  std::string topic, type;
  std::string partition;    // the first; empty: the default one
  std::string participant;  // GUID
  bool is_latched = false;  // a late reader may get its last samples
};

class PresentTopics {
 public:
  explicit PresentTopics(Participant& participant);
  ~PresentTopics();
  PresentTopics(const PresentTopics&) = delete;
  PresentTopics& operator=(const PresentTopics&) = delete;

  // The reader has samples when writers have changed.
  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }
  // Takes the samples. Returns true if writers have come or gone.
  bool poll();
  // The writers by instance handle, which is the publication handle of a writer's samples.
  [[nodiscard]] const std::map<std::uint64_t, PresentWriter>& writers() const noexcept {
    return writers_;
  }
  // "rt/tf (2), rt/scan", at most ten topics, without those that every node of ROS 2 publishes; "no
  // other program" if no other program publishes.
  [[nodiscard]] std::string listed() const;
  // Ends each sentence about topics that no program publishes on this network (Participant::where):
  // "on domain 7, ...; there is: rt/tf. Nothing is heard across ...".
  [[nodiscard]] std::string instead_on(const std::string& where) const;

 private:
  dds_entity_t participant_, reader_;
  std::map<std::uint64_t, PresentWriter> writers_;
};

}  // namespace clearance
