// A residual is explained if it is no longer, along every direction, than the errors allow: the
// places that they allow are a convex set around the model's place, to first order.
#include "monitor/replay/explained_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/text/spelling.hpp"

namespace clearance {
namespace {

// The largest displacement along a unit direction by the error of a source, m, without that of its
// joint's position; and by a position error of this size, rad or m.
double without_position(const ErrorSource& source, const Vec3& arm, const Vec3& n) noexcept {
  return source.translation + source.rotation * arm.cross(n).norm();
}
double by_position(const ErrorSource& source, const Vec3& arm, const Vec3& axis, const Vec3& n,
                   double error) noexcept {
  return error * std::abs(source.slide > 0.0 ? axis.dot(n) : axis.dot(arm.cross(n)));
}
double position_error(const ErrorSource& source) noexcept { return source.turn + source.slide; }

// Unit directions that are spread evenly.
std::vector<Vec3> spread_directions() {
  constexpr int kCount = 2000;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> directions;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount, r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return directions;
}

}  // namespace

std::variant<LinkByName, std::string> link_by_name(const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    for (std::uint32_t l = 0; l < scene.robots[r].links.size(); ++l) {
      names.push_back(scene.robots[r].links[l].name);
      if (names.back() == name) return LinkByName{r, l, name};
    }
  }
  return fmt::format("found no link '{}'; expected a link of a robot of the cell{}", name,
                     did_you_mean(name, names));
}

ExplainedPlaces::ExplainedPlaces(const Scene& scene, LinkByName link)
    : scene_(scene), link_(std::move(link)), errors_(scene), directions_(spread_directions()) {}

bool ExplainedPlaces::add_sources(const Monitor& monitor, std::uint32_t last, const Vec3& at,
                                  Place& place) const {
  for (std::uint32_t s = last; s != ErrorSource::kNone; s = errors_.sources()[s].parent) {
    const ErrorSource& source = errors_.sources()[s];
    const PresentPose by = source.on_link ? monitor.present_link(source.robot, source.link)
                                          : monitor.present_pose(source.object);
    if (by.state != PresentPose::State::kUsable) return false;
    const Pose& pose = by.world_from_body;
    place.sources.push_back({.index = s,
                             .arm = at - transform(pose, source.origin),
                             .axis = pose.orientation.normalized() * source.axis});
  }
  return true;
}

bool ExplainedPlaces::add(const Monitor& monitor, const Vec3& measured,
                          std::optional<std::uint32_t> tracked) {
  const PresentPose at = monitor.present_link(link_.robot, link_.link);
  if (at.state != PresentPose::State::kUsable) return false;
  Place place;
  place.residual = measured - at.world_from_body.position;
  if (!add_sources(monitor, errors_.source_of_link(link_.robot, link_.link),
                   at.world_from_body.position, place))
    return false;
  if (tracked && !add_sources(monitor, errors_.source_of(*tracked), measured, place)) return false;
  places_.push_back(std::move(place));
  return true;
}

double ExplainedPlaces::factor(const Place& place) const {
  double most = 0.0;
  for (const Vec3& n : directions_) {
    const double wanted = place.residual.dot(n);
    if (!(wanted > 0.0)) continue;
    double allowed = 0.0;
    for (const Place::Source& at : place.sources) {
      const ErrorSource& source = errors_.sources()[at.index];
      allowed += without_position(source, at.arm, n) +
                 by_position(source, at.arm, at.axis, n, position_error(source));
    }
    most = std::max(most, wanted / allowed);
  }
  return most;
}

double ExplainedPlaces::factor() const {
  double most = 0.0;
  for (const Place& place : places_) most = std::max(most, factor(place));
  return most;
}

// The least position error of this source with which all places are explained, the others being as
// stated; infinity: none is.
double ExplainedPlaces::least_position(std::uint32_t index) const {
  double least = 0.0;
  for (const Place& place : places_) {
    for (const Vec3& n : directions_) {
      double wanted = place.residual.dot(n), reach = 0.0;
      for (const Place::Source& at : place.sources) {
        const ErrorSource& source = errors_.sources()[at.index];
        wanted -= without_position(source, at.arm, n);
        if (at.index == index) {
          reach = by_position(source, at.arm, at.axis, n, 1.0);
        } else {
          wanted -= by_position(source, at.arm, at.axis, n, position_error(source));
        }
      }
      if (wanted > 0.0) least = std::max(least, wanted / reach);
    }
  }
  return least;
}

std::string ExplainedPlaces::text() const {
  std::vector<double> lengths;
  double most = 0.0;
  std::size_t worst = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    lengths.push_back(1e3 * places_[i].residual.norm());
    const double needed = factor(places_[i]);
    if (needed > most) worst = i;
    most = std::max(most, needed);
  }
  const Vec3 off = 1e3 * places_[worst].residual;
  std::ranges::sort(lengths);
  std::string text = fmt::format(
      "{}: {} places, off the model by {:.2f} mm in the median, {:.2f} at most; worst is place {}, "
      "off by ({:.2f}, {:.2f}, {:.2f}) mm\n{}: all are within {:.3g} times the stated errors\n",
      link_.name, places_.size(), lengths[lengths.size() / 2], lengths.back(), worst + 1, off.x(),
      off.y(), off.z(), most <= 1.0 ? "explained" : "NOT EXPLAINED", most);
  std::string joints;
  for (const Place::Source& at : places_.front().sources) {
    const ErrorSource& source = errors_.sources()[at.index];
    if (!(position_error(source) > 0.0)) continue;
    const double least = least_position(at.index);
    joints += fmt::format("  {:<36} {:>9.3f} {:>9} {}\n", text_of(source, scene_),
                          1e3 * position_error(source),
                          least < 1.0 ? fmt::format("{:.3f}", 1e3 * least) : "none",
                          source.slide > 0.0 ? "mm" : "mrad");
  }
  if (!joints.empty())
    text += fmt::format(
        "  {:<36} {:>9} {:>9}\n{}  would do: the least with which all places are "
        "explained, if only this one changes\n",
        "position error of", "stated", "would do", joints);
  return text;
}

}  // namespace clearance
