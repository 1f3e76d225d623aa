// The command line of programs that record: what a recording holds, and in how many files.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "monitor/recording/options.hpp"

namespace clearance {

struct RecordingArguments {
  bool uncompressed = false;
  std::vector<std::string> without;  // keys of the cell's `topics`
  std::uint64_t pairs_every = 1;
  double roll_mb = 0.0, roll_s = 0.0, attach_mb = 64.0;

  // `prefix`: what the options' names begin with, "--record-" or "--".
  void add_to(CLI::App& app, const std::string& prefix);

  // All but `overwrite`.
  [[nodiscard]] RecordingOptions options(bool overwrite) const;
};

}  // namespace clearance
