// Makes the memory of a monitor, and answers what only a person asks of it.
#include "monitor/tick/monitor_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <set>
#include <span>
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

Monitor::State::State(const Scene& the_scene, const State* similar)
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
              scheduler.left_out(), share,
              similar == nullptr ? KnownHulls{}
                                 : KnownHulls{similar->scene.objects, similar->culling.hulls()}),
      crossings(zone_levels, std::min<std::size_t>(scene.pairs.size(), scene.budget)),
      contacts(the_scene),
      zones(the_scene, zone_levels, contacts),
      separations(the_scene, zone_levels),
      stops(the_scene),
      differentiation(the_scene),
      hidden(the_scene),
      self_test(constant_memory(), similar == nullptr ? nullptr : &similar->self_test) {
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

ConstantMemory Monitor::State::constant_memory() const {
  ConstantMemory memory(SelfTest::kBytesATick);
  memory.add(scene);
  memory.begin("the monitor");
  memory.add_value("share of the budget", share);
  memory("first parts of objects", first_part);
  memory("published pairs", published.pairs);
  memory("which pairs are published", published.is_published);
  memory("named sources", named_sources);
  zone_levels.each_constant(memory);
  inputs.robots.each_constant(memory);
  errors.each_constant(memory);
  table.each_constant(memory);
  separations.each_constant(memory);
  differentiation.each_constant(memory);
  for (const PosedPart& first : std::span(parts).first(std::min<std::size_t>(parts.size(), 1))) {
    const auto* const begin = reinterpret_cast<const std::byte*>(&first.shape);
    const auto* const end = reinterpret_cast<const std::byte*>(&first + 1);
    memory.add_part("objects of parts", std::span(parts), &first.object,
                    sizeof first.object + sizeof first.index_in_object);
    memory.add_part("constants of parts", std::span(parts), begin,
                    static_cast<std::size_t>(end - begin));
  }
  if (table.pairs() > 0) {
    const PairEntry& first = table.entries.front();
    memory.add_part("objects of pairs", std::span<const PairEntry>(table.entries), &first.object_a,
                    sizeof first.object_a + sizeof first.object_b);
  }
  std::set<const ConvexBody*> listed;  // objects share hulls
  for (std::uint32_t i = 0; i < culling.hulls().size(); ++i) {
    const ConvexBody* const hull = culling.hulls()[i].get();
    if (hull == nullptr || !listed.insert(hull).second) continue;
    memory.begin(fmt::format("the hull of '{}'", scene.objects[i].name));
    memory.add_value("its figures", *hull);
    memory.add(*hull);
  }
  memory.begin("the known queries");
  memory("queries", known_queries());
  for (const KnownQuery& query : known_queries()) {
    memory.add(query.a);
    memory.add(query.b);
  }
  return memory;
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

const SelfTest& Monitor::self_test() const noexcept { return state_->self_test; }

const StatedErrors& Monitor::stated_errors() const noexcept { return state_->errors.stated(); }

bool Monitor::response_is_late() const noexcept {
  const Inputs& inputs = state_->inputs;
  return inputs.time.report_delay_ns >= 0 &&
         (state_->displacer.result().response_is_late || inputs.robots.response_is_late());
}

}  // namespace clearance
