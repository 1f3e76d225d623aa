// How many source names one DDS writer may use. Cyclone keeps an instance for every name that a
// reader has stored, for as long as the name's writer lives: a writer with a new name in every
// sample would cost 600 bytes each, for good. What is refused here is never stored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <vector>

namespace clearance {

// Cyclone's receiving threads ask; the taking thread says who has left. Writers and names are known
// by their instance handles.
class NameLimit {
 public:
  // Names of a writer at a time: one that was not used for kForgottenNs makes room for another.
  static constexpr std::size_t kNames = 16;
  static constexpr std::int64_t kForgottenNs = 10'000'000'000;
  // Names of a writer in all, which bounds the memory: about 600 kB.
  static constexpr std::size_t kNamesInAll = 1000;

  // Whether a sample may be stored; one that may not is counted.
  [[nodiscard]] bool admits(std::uint64_t writer, std::uint64_t name, std::int64_t monotonic_ns);
  // The name's last writer has unregistered it: Cyclone has freed it.
  void forget_name(std::uint64_t name);
  // Of the writers, only these are still there.
  void keep(std::span<const std::uint64_t> writers);
  [[nodiscard]] std::uint64_t refused() const;

 private:
  struct Name {
    std::uint64_t handle;
    std::int64_t used_ns;
  };
  struct Writer {
    std::vector<Name> names;
    std::size_t in_all = 0;
  };
  mutable std::mutex mutex_;
  std::map<std::uint64_t, Writer> writers_;
  std::uint64_t refused_ = 0;
};

}  // namespace clearance
