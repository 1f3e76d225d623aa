#include "tools/robot/simulated_people.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace clearance {

SimulatedPeople::SimulatedPeople(const Cell& cell, client::Connection& connection)
    : tracker_(connection, cell.ros.world_frame, cell.ros.moveit.tracked_bodies) {
  const bool are_listed = !cell.ros.moveit.tracked_bodies.empty();
  for (const Robot& robot : cell.scene.robots) {
    if (!robot.person) continue;
    const auto frame =
        std::ranges::find(cell.simulation.frames, robot.base.frame, &SimulatedFrame::name);
    if (frame == cell.simulation.frames.end()) {
      left_out_.push_back(robot.name);
      continue;
    }
    Person person{.id = robot.person->id, .frame = &*frame, .skeleton = {}};
    if (are_listed) person.id = ids_.emplace_back(fmt::format("simulated_{}", ids_.size() + 1));
    const std::string named = "_" + robot.person->id;
    for (std::uint32_t i = 0; i < cell.scene.variables.size(); ++i) {
      const JointVariable& joint = cell.scene.variables[i];
      if (&cell.scene.robots[joint.robot] != &robot || robot.is_of_base(i)) continue;
      person.skeleton.angles.emplace_back(joint.name.substr(0, joint.name.size() - named.size()),
                                          0.0);
    }
    people_.push_back(std::move(person));
  }
}

void SimulatedPeople::send(double t_s, std::int64_t stamp_ns) {
  if (!ids_.empty()) tracker_.list(ids_, stamp_ns);
  for (Person& person : people_) {
    person.skeleton.world_from_body = frame_at(*person.frame, t_s);
    tracker_.tell(person.id, person.skeleton, stamp_ns);
  }
}

}  // namespace clearance
