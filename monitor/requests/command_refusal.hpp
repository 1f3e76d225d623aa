// Why a command is not done, as the steps of monitor/requests return it.
#pragma once

#include <cstddef>
#include <string>

#include "monitor/interface/command.hpp"

namespace clearance {

struct CommandRefusal {
  CommandStatus status = CommandStatus::kFailed;
  std::size_t change = 0;  // index of the change that is at fault
  std::string path = {};   // as in CommandResult
  std::string reason = {};
};

}  // namespace clearance
