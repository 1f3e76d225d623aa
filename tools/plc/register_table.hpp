// The registers that a controller reads: the figures as words, and what each address means.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "config/cell/plc_settings.hpp"
#include "tools/plc/encoding.hpp"
#include "tools/plc/held_figures.hpp"

namespace clearance::plc {

class RegisterTable {
 public:
  // All rows are fail-safe. `settings` outlives this.
  explicit RegisterTable(const PlcSettings& settings);

  // Writes all rows. `refused_writes` counts since the start.
  void update(const HeldFigures& figures, std::uint64_t refused_writes);

  // From address 0 on; addresses between rows are 0.
  [[nodiscard]] std::span<const std::uint16_t> words() const noexcept { return words_; }
  [[nodiscard]] std::span<const Encoded> rows() const noexcept { return rows_; }
  // The rows whose figure has come to be above what its type holds, since the last call.
  [[nodiscard]] std::vector<std::size_t> new_misfits();

 private:
  [[nodiscard]] double value(std::size_t row, const HeldFigures& figures,
                             std::uint64_t refused_writes) const;

  const PlcSettings& settings_;
  std::uint16_t layout_;
  std::uint64_t misfits_ = 0;  // since the start
  std::vector<std::size_t> new_misfits_;
  std::vector<Encoded> rows_;
  std::vector<std::uint16_t> words_;
};

// "zone people: speed_scaling".
[[nodiscard]] std::string name(const PlcRow& row);
// A number that changes when an address, a type, a unit, a scale or a name does; never 0.
[[nodiscard]] std::uint16_t layout(const PlcSettings& settings);
// The table for the person who programs the controller, a line a row.
[[nodiscard]] std::string describe(const PlcSettings& settings);

}  // namespace clearance::plc
