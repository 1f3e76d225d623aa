// Logs when an allowed contact comes into force, ends, or is not as allowed.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/scene_map.hpp"
#include "monitor/report.hpp"

namespace clearance {

class ContactLog {
 public:
  // The most lines between two calls of end_second().
  static constexpr std::uint64_t kLines = 20;

  // The scene must outlive this.
  explicit ContactLog(const Scene& scene) : scene_(scene), logged_(contact_pairs(scene).size()) {}

  // Before the first note(), for a changed scene: what was logged there is no news. `map` is that
  // of the two scenes.
  void take_over(const ContactLog& before, const SceneMap& map);

  // `contacts` of a report. Contacts that are not known or absent are no news: the log says why by
  // other lines.
  void note(std::span<const ContactReport> contacts);
  // Logs the number of changes that have been left out since the last call.
  void end_second();

 private:
  const Scene& scene_;
  std::vector<std::optional<ContactStatus>> logged_;  // by entry
  std::uint64_t lines_ = 0, left_out_ = 0;
};

}  // namespace clearance
