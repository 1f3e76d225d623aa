#include "monitor/inputs/source_numbers.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace clearance {

std::vector<SourceName> named_sources(const Scene& scene) {
  std::vector<SourceName> named;
  const auto add = [&named](const std::string& source) {
    const SourceName name(source);
    if (!source.empty() && std::ranges::find(named, name) == named.end()) named.push_back(name);
  };
  for (const Object& object : scene.objects) add(object.source);
  for (const JointVariable& variable : scene.variables) add(variable.source);
  return named;
}

SourceNumbers::SourceNumbers(const Scene& scene) {
  for (const SourceName& source : named_sources(scene)) {
    named_ = std::max<std::size_t>(named_, of(source) + 1);
  }
}

// A number that was never used has last_use 0 and is therefore chosen first.
std::uint32_t SourceNumbers::of(const SourceName& source) noexcept {
  auto place = std::ranges::find_if(places_, [&](const Place& candidate) {
    return candidate.last_use > 0 && candidate.source == source;
  });
  if (place == places_.end()) {
    place =
        std::ranges::min_element(std::next(places_.begin(), static_cast<std::ptrdiff_t>(named_)),
                                 places_.end(), {}, &Place::last_use);
    place->source = source;
  }
  place->last_use = ++uses_;
  return static_cast<std::uint32_t>(place - places_.begin());
}

void SourceNumbers::append(const PoseBatch& batch, std::vector<PoseSample>& poses,
                           std::vector<JointSample>& joints) {
  const std::uint32_t number = of(batch.source), namesake = namesake_of(batch.source);
  const auto mark = [&](auto& sample) {
    sample.source = number;
    sample.namesake = namesake;
  };
  for (const PoseSample& sample : batch.samples) mark(poses.emplace_back(sample));
  for (const JointSample& sample : batch.joints) mark(joints.emplace_back(sample));
}

std::uint32_t SourceNumbers::namesake_of(const SourceName& source) const noexcept {
  const std::string_view name = source.view();
  const std::size_t mark = name.rfind('#');
  if (mark == name.npos || name.find_first_not_of("0123456789", mark + 1) != name.npos)
    return kNoSource;
  const auto place = std::ranges::find_if(places_, [&](const Place& candidate) {
    return candidate.last_use > 0 && candidate.source.view() == name.substr(0, mark);
  });
  return place == places_.end() ? kNoSource : static_cast<std::uint32_t>(place - places_.begin());
}

SourceName SourceNumbers::name(std::uint32_t number) const noexcept {
  return number < kMaxSources ? places_[number].source : SourceName();
}

}  // namespace clearance
