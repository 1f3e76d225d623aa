#include "monitor/examples/arm/world.hpp"

#include <string>

#include "config/cell/simulation.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

std::vector<std::string> names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const JointVariable& variable : scene.variables) names.push_back(variable.name);
  return names;
}

}  // namespace

World::World(const Cell& cell, client::Connection& connection, std::string_view arm,
             std::string_view objects)
    : cell_(cell), joints_(connection, arm, names_of(cell.scene)), poses_(connection, objects) {}

std::int64_t World::send(double t_s, const std::vector<double>& positions,
                         const std::vector<double>& velocities) {
  const std::int64_t stamp_ns = client::now_ns();
  poses_at(cell_.simulation, t_s, objects_);
  sent_.resize(objects_.size());
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    to_wire({.object = objects_[i].object,
             .stamp_ns = stamp_ns,
             .world_from_object = objects_[i].world_from_object,
             .twist = objects_[i].twist,
             .has_twist = true},
            sent_[i]);
  }
  poses_.write(sent_, cell_.scene.revision);
  joints_.write(positions, velocities, stamp_ns);
  return stamp_ns;
}

}  // namespace clearance
