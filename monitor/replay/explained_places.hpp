// Whether the stated errors of a cell's model explain where links were measured: by a tracker, or
// by touching known points. It fits nothing: to find better parameters is a calibration's task.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "config/scene/stated_errors.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// A link by its indices, and its name.
struct LinkByName {
  std::uint32_t robot = 0, link = 0;
  std::string name;
};
// Returns a sentence where there is none, with the nearest name.
[[nodiscard]] std::variant<LinkByName, std::string> link_by_name(const Scene& scene,
                                                                 const std::string& name);

class ExplainedPlaces {
 public:
  // The scene must outlive it.
  ExplainedPlaces(const Scene& scene, LinkByName link);

  // The link's origin was at `measured` in the world, m, at the last tick. `tracked`: the object
  // whose pose says so, and may be wrong by its own error. Returns false if the place of the link
  // is not known.
  bool add(const Monitor& monitor, const Vec3& measured,
           std::optional<std::uint32_t> tracked = std::nullopt);

  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }
  // The stated errors are for all places together to be multiplied by this, at least; at most 1:
  // they explain them.
  [[nodiscard]] double factor() const;
  // The residuals, the factor, and for each joint the error that would do alone. Needs a place.
  [[nodiscard]] std::string text() const;

 private:
  struct Place {
    Vec3 residual;  // from the model's place to the measured one, m
    // What each source can do along a direction follows from these, in the world.
    struct Source {
      std::uint32_t index;
      Vec3 arm, axis;  // from its origin to the place; unit
    };
    std::vector<Source> sources;
  };

  [[nodiscard]] bool add_sources(const Monitor& monitor, std::uint32_t last, const Vec3& at,
                                 Place& place) const;
  [[nodiscard]] double factor(const Place& place) const;
  [[nodiscard]] double least_position(std::uint32_t index) const;

  const Scene& scene_;
  LinkByName link_;
  StatedErrors errors_;
  std::vector<Vec3> directions_;
  std::vector<Place> places_;
};

}  // namespace clearance
