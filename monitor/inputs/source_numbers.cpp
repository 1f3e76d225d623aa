#include "monitor/inputs/source_numbers.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "monitor/inputs/state_bytes.hpp"

namespace clearance {
namespace {

constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();

}  // namespace

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

SourceNumbers::SourceNumbers(const Scene& scene) { add_named(named_sources(scene)); }

bool SourceNumbers::add_named(std::span<const SourceName> sources) noexcept {
  auto free = static_cast<std::ptrdiff_t>(kMaxSources) -
              std::ranges::count(places_, true, &Place::is_named);
  for (const SourceName& source : sources) {
    const Place* place = find(source);
    if (place == nullptr || !place->is_named) --free;
  }
  if (free < 0) return false;
  for (const SourceName& source : sources) places_[of(source)].is_named = true;
  return true;
}

// Sources that the cell names come first, and keep their numbers.
bool SourceNumbers::is_sound(const SourceNumbers& own) const noexcept {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const Place &place = places_[i], &stated = own.places_[i];
    if (!are_flags(place.is_named) || !place.source.is_sound()) return false;
    if (stated.is_named && !(place.is_named && place.source == stated.source)) return false;
  }
  return true;
}

const SourceNumbers::Place* SourceNumbers::find(const SourceName& source) const noexcept {
  const auto place = std::ranges::find_if(places_, [&](const Place& candidate) {
    return candidate.last_use > 0 && candidate.source == source;
  });
  return place == places_.end() ? nullptr : &*place;
}

// A number that was never used has last_use 0 and is therefore chosen first.
std::uint32_t SourceNumbers::of(const SourceName& source) noexcept {
  const auto last_use = [](const Place& place) { return place.is_named ? kLast : place.last_use; };
  const Place* known = find(source);
  Place& place =
      known != nullptr ? places_[index(*known)] : *std::ranges::min_element(places_, {}, last_use);
  if (known == nullptr && place.is_named) return kNoSource;
  place.source = source;
  place.last_use = ++uses_;
  return index(place);
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
  const std::string_view suffix = writer_suffix(source.view());
  const std::string_view stem = source.view().substr(0, source.view().size() - suffix.size());
  if (suffix.empty() || stem.empty()) return kNoSource;
  const std::size_t most = kMaxSourceLength - suffix.size();
  const auto place = std::ranges::find_if(places_, [&](const Place& candidate) {
    const std::string_view name = candidate.source.view();
    return candidate.is_named && name.substr(name.size() - std::min(name.size(), most)) == stem;
  });
  return place == places_.end() ? kNoSource : index(*place);
}

SourceName SourceNumbers::name(std::uint32_t number) const noexcept {
  return number < kMaxSources ? places_[number].source : SourceName();
}

}  // namespace clearance
