// Converts messages of an older or newer build to the layout of this build.
//
// A recording carries the IDL of its messages. If that differs from the IDL of this build, fields
// are matched by their names. Fields that the recording lacks are filled in as not known. Fields
// that this build does not know are left out.
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

  // The reason why the messages cannot be read, as the end of a sentence. Empty: they can be read.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  // True when both layouts are the same, so no conversion is needed.
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
