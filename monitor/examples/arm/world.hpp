// What an example sends to the daemon: its arm, and the objects of the cell's simulation.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"

namespace clearance {

class World {
 public:
  // The names are those of the two sources. The cell must outlive it.
  World(const Cell& cell, client::Connection& connection, std::string_view arm,
        std::string_view objects);

  // Sends both under one stamp, which it returns. The objects are where they are `t_s` seconds
  // after their start. Positions and velocities have the order of Scene::variables.
  std::int64_t send(double t_s, const std::vector<double>& positions,
                    const std::vector<double>& velocities);

 private:
  const Cell& cell_;
  client::JointWriter joints_;
  client::PoseWriter poses_;
  std::vector<PoseAt> objects_;
  std::vector<clearance_msg_ObjectPose> sent_;
};

}  // namespace clearance
