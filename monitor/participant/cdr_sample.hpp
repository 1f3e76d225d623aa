// Samples in CDR that are not decoded, for programs that record, count or decode them elsewhere.
#pragma once

#include <dds/dds.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct ddsi_serdata;

namespace clearance {

// One sample in CDR. Cyclone keeps it as long as this object lives.
class CdrSample {
 public:
  // Takes over the reference.
  CdrSample(ddsi_serdata* sample, const dds_sample_info_t& info)
      : source_ns_(info.source_timestamp), writer_(info.publication_handle), sample_(sample) {}

  // When it was written, CLOCK_REALTIME of its writer.
  [[nodiscard]] std::int64_t source_ns() const noexcept { return source_ns_; }
  // The writer that sent it, as its reader knows it.
  [[nodiscard]] dds_instance_handle_t writer() const noexcept { return writer_; }
  // The bytes with their 4-byte header, valid as long as this object.
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
// how many it took, those included; 0: none was waiting. If `ended` is not null, it gets the
// handles of keys that no longer have a writer. Throws DdsError.
inline constexpr std::size_t kMostAtOnce = 64;
std::size_t take_cdr(dds_entity_t reader, std::vector<CdrSample>& taken,
                     std::vector<std::uint64_t>* ended = nullptr);

}  // namespace clearance
