// Messages of an older or newer build, in the layout that this build has.
//
// A recording carries the IDL of its messages. Where that differs from ours, fields are found again
// by their names: what the recording lacks is filled in as not known, what this build does not know
// is left out.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/recording/idl_types.hpp"

namespace clearance {

class LayoutChange {
 public:
  // `type`: the struct's name in both texts, without modules.
  LayoutChange(std::string_view recorded_idl, std::string_view our_idl, std::string_view type);

  // Not empty: why the messages cannot be read, as the end of a sentence.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // Whether there is nothing to do.
  [[nodiscard]] bool is_none() const noexcept { return error_.empty() && is_same_; }
  // Fields that the recording lacks: "Distances.queries".
  [[nodiscard]] const std::set<std::string>& not_recorded() const noexcept { return not_recorded_; }

  // CDR of the recorded layout to CDR of ours, header included: XCDR1, little-endian, as recorders
  // write it. Empty when the bytes are not of the recorded layout. A number that was not recorded
  // becomes 0, or NaN where it is a double; a list or text becomes empty.
  [[nodiscard]] std::span<const std::byte> apply(std::span<const std::byte> cdr);

 private:
  IdlType recorded_, ours_;
  std::string error_;
  bool is_same_ = true;
  std::set<std::string> not_recorded_;
  std::vector<std::byte> out_;
};

}  // namespace clearance
