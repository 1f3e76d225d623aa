// The command line of programs that record: the topics in a recording and its number of files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "monitor/app/command_line.hpp"
#include "monitor/recording/options.hpp"

namespace clearance {

struct RecordingArguments {
  bool uncompressed = false;
  std::vector<std::string> without;  // keys of the cell's `topics`
  std::uint64_t pairs_every = 1;
  double roll_mb = 0.0, roll_s = 0.0;

  // `prefix` begins the names of the options: "--record-" or "--".
  void add_to(CommandLine& line, const std::string& prefix);

  double around_s = 0.0, ring_mb = 256.0, keep_h = 0.0;
  std::optional<double> keep_mb;
  std::uint64_t ticks_every = 1, clouds_every = 1;

  // Adds what only a recorder that sees every tick can do: events, and ticks that are left out.
  void add_events_to(CommandLine& line, const std::string& prefix);
  [[nodiscard]] bool by_event() const noexcept { return around_s > 0.0; }

  // The options except `overwrite`.
  [[nodiscard]] RecordingOptions options(bool overwrite) const;
};

}  // namespace clearance
