#include "monitor/dds/name_limit.hpp"

#include <algorithm>

#include "monitor/loop/ports.hpp"

namespace clearance {
namespace {

bool admits(const dds_sample_info_t* info, void* names) {
  return static_cast<NameLimit*>(names)->admits(info->publication_handle, info->instance_handle,
                                                SystemClock().monotonic_ns());
}

}  // namespace

dds_topic_filter filter_of(NameLimit& names) noexcept {
  return {.mode = DDS_TOPIC_FILTER_SAMPLEINFO_ARG, .f = {.sampleinfo_arg = admits}, .arg = &names};
}

bool NameLimit::admits(std::uint64_t writer, std::uint64_t name, std::int64_t monotonic_ns) {
  const Lock lock(mutex_);
  Writer& of = writers_[writer];
  const auto known = std::ranges::find(of.names, name, &Name::handle);
  if (known != of.names.end()) {
    known->used_ns = monotonic_ns;
    return true;
  }
  const auto oldest = std::ranges::min_element(of.names, {}, &Name::used_ns);
  const bool full = of.names.size() == kNames;
  if (of.in_all == kNamesInAll || (full && monotonic_ns - oldest->used_ns < kForgottenNs)) {
    ++refused_;
    return false;
  }
  ++of.in_all;
  if (full) of.names.erase(oldest);
  of.names.push_back({.handle = name, .used_ns = monotonic_ns});
  return true;
}

void NameLimit::forget_name(std::uint64_t name) {
  const Lock lock(mutex_);
  for (auto& [handle, writer] : writers_) {
    writer.in_all -= std::erase_if(writer.names, [&](const Name& n) { return n.handle == name; });
  }
}

void NameLimit::keep(std::span<const std::uint64_t> writers) {
  const Lock lock(mutex_);
  std::erase_if(writers_, [&](const auto& writer) {
    return std::ranges::find(writers, writer.first) == writers.end();
  });
}

std::uint64_t NameLimit::refused() const {
  const Lock lock(mutex_);
  return refused_;
}

}  // namespace clearance
