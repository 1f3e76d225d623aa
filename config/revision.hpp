// The 64-bit FNV-1a hash of a scene's files, by which two scenes are told apart. It detects
// mistakes, not attacks.
#pragma once

#include <cstdint>
#include <string_view>

namespace clearance {

class Revision {
 public:
  void add(std::string_view bytes) noexcept {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    }
  }

  // Never 0: on the wire that means "not checked".
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_ == 0 ? 1 : hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace clearance
