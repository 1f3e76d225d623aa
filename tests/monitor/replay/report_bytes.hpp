// The content of a report as bytes, which are equal if and only if the reports are equal to the
// bit.
#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

#include "monitor/interface/report_fields.hpp"

namespace clearance::test {

// Appends a value of any field: a record field by field, a list element by element.
struct AppendBytes {
  std::vector<unsigned char>& bytes;

  template <class Value>
  void operator()(const Field&, const Value& value) const {
    if constexpr (HasFields<Value>) {
      for_each_field(*this, value);
    } else if constexpr (std::is_same_v<Value, Vec3>) {
      for (int i = 0; i < 3; ++i) (*this)(Field{}, value[i]);
    } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value>) {
      const std::size_t size = bytes.size();
      bytes.resize(size + sizeof value);
      std::memcpy(bytes.data() + size, &value, sizeof value);
    } else {
      for (const auto& element : value) (*this)(Field{}, element);
    }
  }
};

[[nodiscard]] inline std::vector<unsigned char> bytes_of(const Report& report) {
  std::vector<unsigned char> bytes;
  for_each_field(AppendBytes{bytes}, report);
  return bytes;
}

}  // namespace clearance::test
