// The source of the messages: a daemon, or a recording.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "config/cell/cell.hpp"
#include "tools/view/server.hpp"

namespace clearance::view {

class Source {
 public:
  Source() = default;
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  // The cell that is shown. It is another one after the daemon changed its cell, or where the
  // recording has another one.
  [[nodiscard]] virtual std::shared_ptr<const Cell> cell() const = 0;

  // Publishes new messages; called 60 times a second.
  virtual void advance(Server& server) = 0;

  // Parameters that viewers may read and set: an array of {name, value}. set() ignores unknown
  // names.
  [[nodiscard]] virtual nlohmann::json parameters() const { return nlohmann::json::array(); }
  virtual void set(const std::string& /*name*/, const nlohmann::json& /*value*/) {}

  // The curves of so many seconds before this moment of a recording (RunHistory::window); else
  // "null".
  [[nodiscard]] virtual std::string history(double /*end_s*/, double /*width_s*/,
                                            std::span<const std::uint32_t> /*pairs*/) const {
    return "null";
  }
  // The distance of two objects as they are shown (Frame::distance_json).
  [[nodiscard]] virtual std::string distance(std::uint32_t a, std::uint32_t b) = 0;
  // The newest frames of the cell's sensors (sensors_json.hpp).
  [[nodiscard]] virtual std::string sensors() const { return "[]"; }
  // The time line of a recording as JSON; "null" where there is none.
  [[nodiscard]] virtual std::string timeline() const { return "null"; }
};

}  // namespace clearance::view
