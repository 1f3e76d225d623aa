#include "monitor/participant/cdr_sample.hpp"

#include <array>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/cyclone_private.hpp"

namespace clearance {

// Cyclone keeps the bytes of a sample contiguous. It returns them with an additional reference,
// which is not needed, because this object has one.
std::span<const std::byte> CdrSample::bytes() const {
  ddsrt_iovec_t part{};
  ddsi_serdata* const same =
      ddsi_serdata_to_ser_ref(sample_.get(), 0, ddsi_serdata_size(sample_.get()), &part);
  ddsi_serdata_to_ser_unref(same, &part);
  return {static_cast<const std::byte*>(part.iov_base), part.iov_len};
}

void CdrSample::Release::operator()(ddsi_serdata* sample) const noexcept {
  ddsi_serdata_unref(sample);
}

std::size_t take_cdr(dds_entity_t reader, std::vector<CdrSample>& taken,
                     std::vector<std::uint64_t>* ended) {
  std::array<ddsi_serdata*, kMostAtOnce> samples{};
  std::array<dds_sample_info_t, kMostAtOnce> infos;
  const auto count = static_cast<std::size_t>(
      check_dds(dds_takecdr(reader, samples.data(), kMostAtOnce, infos.data(), DDS_ANY_STATE),
                "taking samples"));
  for (std::size_t i = 0; i < count; ++i) {
    CdrSample sample(samples[i], infos[i]);
    if (infos[i].valid_data) taken.push_back(std::move(sample));
    const bool has_writers = infos[i].instance_state == DDS_IST_ALIVE;
    if (ended != nullptr && !has_writers) ended->push_back(infos[i].instance_handle);
  }
  return count;
}

}  // namespace clearance
