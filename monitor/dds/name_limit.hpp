// Limits the number of source names that one DDS writer may use.
//
// Cyclone keeps an instance for every name that a reader has stored, for as long as the name's
// writer lives. A writer with a new name in every sample would cost 600 bytes for each,
// permanently. Samples that are refused here are never stored.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "monitor/interface/mutex.hpp"

namespace clearance {

// Cyclone's receiving threads call admits(). The taking thread reports which writers have left.
// Writers and names are known by their instance handles.
class NameLimit {
 public:
  // The number of names of a writer at a time. Another name may replace one that was not used for
  // kForgottenNs.
  static constexpr std::size_t kNames = 16;
  static constexpr std::int64_t kForgottenNs = 10'000'000'000;
  // The total number of names of a writer. It bounds the memory to about 600 kB.
  static constexpr std::size_t kNamesInAll = 1000;

  // True if a sample may be stored; otherwise it is counted.
  [[nodiscard]] bool admits(std::uint64_t writer, std::uint64_t name, std::int64_t monotonic_ns);
  // Call this when the name's last writer has unregistered it, because Cyclone has then freed it.
  void forget_name(std::uint64_t name);
  // Forgets the names of all writers except these, which still exist.
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
  mutable Mutex mutex_;
  GUARDED_BY(mutex_) std::map<std::uint64_t, Writer> writers_;
  GUARDED_BY(mutex_) std::uint64_t refused_ = 0;
};

// A filter for a reader: Cyclone asks it before it stores a sample, with the name's instance handle
// and no decoded sample. The limit must outlive the reader.
[[nodiscard]] dds_topic_filter filter_of(NameLimit& names) noexcept;

}  // namespace clearance
