#include "monitor/participant/cdr_sample.hpp"

#include <array>

#include "monitor/participant/participant.hpp"
#include "monitor/wire/cyclone_private.hpp"

namespace clearance {

void CdrSample::copy_to(std::vector<std::byte>& bytes) const {
  bytes.resize(ddsi_serdata_size(sample_.get()));
  ddsi_serdata_to_ser(sample_.get(), 0, bytes.size(), bytes.data());
}

void CdrSample::Release::operator()(ddsi_serdata* sample) const noexcept {
  ddsi_serdata_unref(sample);
}

std::size_t take_cdr(dds_entity_t reader, std::vector<CdrSample>& taken) {
  std::array<ddsi_serdata*, kMostAtOnce> samples{};
  std::array<dds_sample_info_t, kMostAtOnce> infos;
  const auto count = static_cast<std::size_t>(
      check_dds(dds_takecdr(reader, samples.data(), kMostAtOnce, infos.data(), DDS_ANY_STATE),
                "taking samples"));
  for (std::size_t i = 0; i < count; ++i) {
    CdrSample sample(samples[i], infos[i]);
    if (infos[i].valid_data) taken.push_back(std::move(sample));
  }
  return count;
}

}  // namespace clearance
