// Logs when an allowed contact comes into force, ends, or is not as allowed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

class ContactLog {
 public:
  // The most lines between two calls of end_second().
  static constexpr std::uint64_t kLines = 20;

  // The scene must outlive this, or its use until the next call of change().
  explicit ContactLog(const Scene& scene) { change(scene); }
  // The following reports are of this scene. Contacts are known by their names and those of their
  // pairs: what was logged of one is no news.
  void change(const Scene& scene);

  // `contacts` of a report. Contacts that are not known or absent are no news: the log says why by
  // other lines.
  void note(std::span<const ContactReport> contacts);
  // Logs the number of changes that have been left out since the last call.
  void end_second();

 private:
  // One pair of a contact, and what was logged of it last.
  struct Entry {
    std::string contact, pair;
    std::optional<ContactStatus> status;
    std::uint64_t since_cycle = 0;  // another one: it was allowed anew
  };

  const Scene* scene_ = nullptr;
  std::vector<Entry> entries_;  // as contact_pairs() of the scene
  std::uint64_t lines_ = 0, left_out_ = 0;
};

}  // namespace clearance
