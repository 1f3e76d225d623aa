// The readers of the ROS 2 topics that an intake wants. A reader is made when another program
// begins to publish its topic, or before, so that publishers know of it: see stand().
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "monitor/dds/present_topics.hpp"
#include "monitor/intake/intake.hpp"
#include "monitor/participant/cdr_sample.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

class RosReaders {
 public:
  struct Reader {
    dds_entity_t handle = 0;
    std::uint32_t topic = 0;  // the intake's number
    // A reader of writers that keep their last sample for it. A topic may have one beside the other
    // one, which then leaves those writers to it: both would hand out their samples.
    bool is_latched = false;
  };

  // Participant and intake must outlive this.
  RosReaders(Participant& participant, Intake& intake)
      : participant_(participant), intake_(intake), present_(participant) {}
  ~RosReaders();
  RosReaders(const RosReaders&) = delete;
  RosReaders& operator=(const RosReaders&) = delete;

  // Makes readers for the topics that the cell names. Messages wait in them until poll() knows the
  // writer.
  void stand();
  // Makes readers for topics that have appeared, and after stand() for all. Returns true if writers
  // may have come or gone.
  bool poll();
  [[nodiscard]] const std::vector<Reader>& readers() const noexcept { return readers_; }
  // The topics that other programs publish, and the publication handles of all their writers.
  [[nodiscard]] const PresentTopics& present() const noexcept { return present_; }
  [[nodiscard]] std::vector<std::uint64_t> writers() const;
  // Takes all waiting samples of one of readers() into the intake. `taken` is empty before and
  // after, and keeps its memory.
  void take(const Reader& reader, const Now& now, std::vector<CdrSample>& taken);

 private:
  // Topic, type, and whether it is for writers that keep their samples.
  using Standing = std::tuple<std::string, const dds_topic_descriptor_t*, bool>;

  [[nodiscard]] dds_entity_t reader_of(const RosType& delivery, const std::string& topic);
  [[nodiscard]] bool is_read_by_other(const Reader& reader, std::uint64_t writer) const;

  Participant& participant_;
  Intake& intake_;
  PresentTopics present_;
  std::vector<Reader> readers_;
  bool has_new_names_ = false;  // the cell may name a topic that was there before
  // Readers of stand() that no writer needed yet; 0: the topic has one of readers_.
  std::map<Standing, dds_entity_t> standing_;
};

// The same for any reader. Samples of a writer that does not count are dropped; empty: all count.
void take_into(Intake& intake, std::uint32_t topic, dds_entity_t reader, const Now& now,
               std::vector<CdrSample>& taken, std::vector<std::uint64_t>* ended = nullptr,
               const std::function<bool(std::uint64_t writer)>& counts = {});

}  // namespace clearance
