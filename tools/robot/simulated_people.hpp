// Persons of a cell as a tracker of ROS4HRI tells of them (idl/PEOPLE.md): upright, with arms down.
// They stand or walk where a mover of the cell's simulation has their frame, body_ID. Where the
// cell reads lists of bodies, their ids differ from the names of robots.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"
#include "tools/robot/ros_tracker.hpp"

namespace clearance {

class SimulatedPeople {
 public:
  // The cell and the connection must outlive this.
  SimulatedPeople(const Cell& cell, client::Connection& connection);

  [[nodiscard]] std::size_t size() const noexcept { return people_.size(); }
  // Names of those whose frame nothing moves: nothing is sent of them.
  [[nodiscard]] const std::vector<std::string>& left_out() const noexcept { return left_out_; }
  void send(double t_s, std::int64_t stamp_ns);

 private:
  struct Person {
    std::string id;  // as it is sent
    const SimulatedFrame* frame;
    people::Skeleton skeleton;
  };
  people::RosTracker tracker_;
  std::vector<Person> people_;
  std::vector<std::string> ids_;  // to be listed
  std::vector<std::string> left_out_;
};

}  // namespace clearance
