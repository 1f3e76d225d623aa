// Turns the daemon's reports into a value for each row of registers.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/client/client.hpp"
#include "tools/plc/held_figures.hpp"

namespace clearance::plc {

class ReportFigures {
 public:
  // `cell` outlives this.
  ReportFigures(client::Connection& connection, const Cell& cell);

  // Takes all reports that have come. `now_ns` is client::monotonic_ns().
  void update(std::int64_t now_ns);
  [[nodiscard]] const HeldFigures& held() const noexcept { return held_; }

 private:
  // What the row's zone or robot is in the present scene. Nothing: the scene has it no longer.
  struct Place {
    std::optional<std::uint32_t> zone, robot;
  };
  // Why ids of this scene mean nothing here; kNone: they are known.
  [[nodiscard]] Cause names_of(std::uint64_t revision);
  template <class Message>
  void take(client::Stream<Message>& stream, MessageKind kind, std::int64_t now_ns);
  void fill(const clearance_msg_Distances& report);
  void fill(const clearance_msg_Separation& separation);

  const Cell& cell_;
  const PlcSettings& settings_;
  client::Reports reports_;
  client::Separation separation_;
  client::Catalogue catalogue_;
  HeldFigures held_;
  std::uint64_t revision_ = 0;  // that of `places_`
  std::vector<Place> places_;   // by row
  bool has_zones_ = false;      // the scene has zones
  bool is_separated_ = false;   // the scene has zones with `separation` or robots with `stopping`
  std::vector<double> values_;  // by row, of one message
};

}  // namespace clearance::plc
