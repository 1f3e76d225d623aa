// Makes the memory of a monitor, and answers what only a person asks of it.
#include "monitor/tick/monitor_state.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/bodies/bounding_sphere.hpp"

namespace clearance {
namespace {

Published published_pairs(const Scene& scene) {
  Published published;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    if (scene.pairs[p].publish) published.pairs.push_back(p);
    published.is_published.push_back(scene.pairs[p].publish);
  }
  return published;
}

}  // namespace

Monitor::State::State(const Scene& the_scene, const KnownHulls& known_hulls)
    : scene(the_scene),
      zone_levels(the_scene),
      share(refresh_share(the_scene)),
      first_part(first_parts(the_scene)),
      published(published_pairs(the_scene)),
      named_sources(clearance::named_sources(the_scene)),
      inputs(initial_inputs(the_scene)),
      displacer(the_scene),
      parts(parts_of(the_scene)),
      errors(the_scene),
      table(the_scene, parts),
      scheduler(the_scene, share, parts, table, zone_levels),
      culling(the_scene, parts, table, zone_levels, UrgencyBins::distances_ahead(the_scene),
              scheduler.left_out(), share, known_hulls),
      crossings(zone_levels, std::min<std::size_t>(scene.pairs.size(), scene.budget)),
      contacts(the_scene),
      zones(the_scene, zone_levels, contacts),
      separations(the_scene, zone_levels),
      stops(the_scene),
      differentiation(the_scene),
      hidden(the_scene) {
  const std::vector<BoundingSphere> spheres = bounding_spheres(scene.objects.size(), parts);
  for (std::size_t i = 0; i < spheres.size(); ++i)
    inputs.objects[i].bounding_radius = spheres[i].bounding_radius;
  presence_changed.reserve(scene.objects.size());
  shown.resize(scene.sensors.size());
  if (!scene.sensors.empty()) clouds = std::make_unique<CloudPairs>(scene, parts, table);
  report.scene_revision = scene.revision;
  report.pairs_total = static_cast<std::uint32_t>(scene.pairs.size());
  for (const std::uint32_t pair : published.pairs) report.pairs.push_back(pair_report(pair));
  report.zones.assign(zones.reports().begin(), zones.reports().end());
  report.contacts.assign(contacts.reports().begin(), contacts.reports().end());
  report.hidden.assign(hidden.reports().begin(), hidden.reports().end());
  separations.prepare(report);
  stops.prepare(report);
  report.gradients = unknown_gradients(differentiation.rows());
}

std::vector<ErrorShare> Monitor::error_shares(std::uint32_t pair) const {
  const State& s = *state_;
  const PairReport report = s.pair_report(pair);
  std::vector<ErrorShare> shares;
  if (!s.errors.any() || !report.normal.allFinite()) return shares;
  const ObjectPair& of = s.scene.pairs[pair];
  s.errors.each_share(of.first, of.second, report.witness_a, report.normal,
                      [&](std::uint32_t source, double metres) {
                        if (metres > 0.0) shares.push_back({source, metres});
                      });
  std::ranges::sort(shares, std::ranges::greater{}, &ErrorShare::metres);
  return shares;
}

const StatedErrors& Monitor::stated_errors() const noexcept { return state_->errors.stated(); }

bool Monitor::response_is_late() const noexcept {
  const Inputs& inputs = state_->inputs;
  return inputs.time.report_delay_ns >= 0 &&
         (state_->displacer.result().response_is_late || inputs.robots.response_is_late());
}

}  // namespace clearance
