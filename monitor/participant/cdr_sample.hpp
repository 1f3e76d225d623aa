// Samples as they came, without decoding them: for what passes them on or records them.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

struct ddsi_serdata;

namespace clearance {

// One sample in CDR, which Cyclone keeps as long as this lives.
class CdrSample {
 public:
  // Takes the reference over.
  CdrSample(ddsi_serdata* sample, std::int64_t source_ns)
      : source_ns_(source_ns), sample_(sample) {}

  // When it was written, CLOCK_REALTIME of its writer.
  [[nodiscard]] std::int64_t source_ns() const noexcept { return source_ns_; }
  // The bytes with their header of four.
  void copy_to(std::vector<std::byte>& bytes) const;

 private:
  struct Release {
    void operator()(ddsi_serdata* sample) const noexcept;
  };
  std::int64_t source_ns_;
  std::unique_ptr<ddsi_serdata, Release> sample_;
};

// Appends what waits in the reader, and no more than kMostAtOnce; samples without content are
// passed over. How many were taken, with those: 0, none waits. Throws DdsError.
inline constexpr std::size_t kMostAtOnce = 64;
std::size_t take_cdr(dds_entity_t reader, std::vector<CdrSample>& taken);

}  // namespace clearance
