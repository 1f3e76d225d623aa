// A sequence of a message as a range.
#pragma once

#include <span>

namespace clearance::client {

template <class Sequence>
[[nodiscard]] auto list(const Sequence& sequence) {
  return std::span(sequence._buffer, sequence._length);
}

}  // namespace clearance::client
