// The inputs of a monitor of the cell when each motion of a bag comes: joints, poses, frames of
// sensors, and MoveIt's scene.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/interface/present_inputs.hpp"
#include "monitor/interface/question.hpp"
#include "tools/ask/bag_motions.hpp"

namespace clearance {

struct InputsOfMotion {
  const Cell& cell;  // in force; it may differ from the first one
  const InputState& state;
  std::vector<SeenFrame> frames;  // in use at the tick; those of one stamp share their cloud
};

// Replays the bag as clearance-replay does. Calls `use` for each motion, in order, at a tick of its
// time. Of a recording of our own, that is the first recorded one that is not before it. There is
// none for motions behind the last tick. Returns an empty text, or why the replay ended.
using UseInputs = std::function<void(std::size_t motion, InputsOfMotion inputs)>;
[[nodiscard]] std::string for_each_inputs(const Cell& cell, const std::filesystem::path& bag,
                                          std::span<const BagMotion> motions, const UseInputs& use);

}  // namespace clearance
