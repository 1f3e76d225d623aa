// What others publish in our domain, as discovery knows it: whatever its type and partition.
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
};

class PresentTopics {
 public:
  explicit PresentTopics(Participant& participant);
  ~PresentTopics();
  PresentTopics(const PresentTopics&) = delete;
  PresentTopics& operator=(const PresentTopics&) = delete;

  // Has samples when there is news.
  [[nodiscard]] dds_entity_t reader() const noexcept { return reader_; }
  // Takes the news. True: writers have come or gone.
  bool look();
  // By instance handle, which is the publication handle of the writer's samples.
  [[nodiscard]] const std::map<std::uint64_t, PresentWriter>& writers() const noexcept {
    return writers_;
  }
  // "rt/tf (2), rt/scan", at most ten topics; "no other program" when nobody publishes anything.
  [[nodiscard]] std::string listed() const;

 private:
  dds_entity_t participant_, reader_;
  std::map<std::uint64_t, PresentWriter> writers_;
};

}  // namespace clearance
