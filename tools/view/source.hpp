// Where the messages come from: a daemon, or a recording.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tools/view/server.hpp"

namespace clearance::view {

class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // Publishes what is new; called 60 times a second.
  virtual void advance(Server& server) = 0;

  // What viewers may know and set: an array of {name, value}; set() passes over what it does not
  // know.
  [[nodiscard]] virtual nlohmann::json parameters() const { return nlohmann::json::array(); }
  virtual void set(const std::string& /*name*/, const nlohmann::json& /*value*/) {}

  // Of a recording, what was before this moment (RunHistory::window); "null" where there is none.
  [[nodiscard]] virtual std::string history(double /*end_s*/,
                                            std::span<const std::uint32_t> /*pairs*/) const {
    return "null";
  }
  // The time line of a recording as JSON; "null" where there is none.
  [[nodiscard]] virtual std::string timeline() const { return "null"; }
};

}  // namespace clearance::view
