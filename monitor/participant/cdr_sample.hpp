// Samples in CDR, not decoded: for programs that record them, count them or decode them elsewhere.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct ddsi_serdata;

namespace clearance {

// One sample in CDR, which Cyclone keeps as long as this lives.
class CdrSample {
 public:
  // Takes the reference over.
  CdrSample(ddsi_serdata* sample, const dds_sample_info_t& info)
      : source_ns_(info.source_timestamp), writer_(info.publication_handle), sample_(sample) {}

  // When it was written, CLOCK_REALTIME of its writer.
  [[nodiscard]] std::int64_t source_ns() const noexcept { return source_ns_; }
  // The writer that sent it, as its reader knows it.
  [[nodiscard]] dds_instance_handle_t writer() const noexcept { return writer_; }
  // The bytes with their header of four, valid as long as this is.
  [[nodiscard]] std::span<const std::byte> bytes() const;

 private:
  struct Release {
    void operator()(ddsi_serdata* sample) const noexcept;
  };
  std::int64_t source_ns_;
  dds_instance_handle_t writer_;
  std::unique_ptr<ddsi_serdata, Release> sample_;
};

// Appends at most kMostAtOnce of the waiting samples, without those that have no content. Returns
// how many it took, those included; 0: none was waiting. `ended`, unless null, gets the handles of
// keys that no writer has any more. Throws DdsError.
inline constexpr std::size_t kMostAtOnce = 64;
std::size_t take_cdr(dds_entity_t reader, std::vector<CdrSample>& taken,
                     std::vector<std::uint64_t>* ended = nullptr);

}  // namespace clearance
