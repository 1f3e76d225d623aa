// Messages that give one input two values at one time.
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>
#include <vector>

namespace clearance {

// Of two values of one input at one time in one message, none could be meant: `refuse` makes both
// of them NaN, which is refused as not finite. Most messages have their inputs in the order of the
// scene. Others are sorted, since a message may have as many entries as its sender likes.
template <class Sample, class Key, class Same, class Refuse>
void refuse_two_values(std::vector<Sample>& samples, const Key& key, const Same& same,
                       const Refuse& refuse) {
  if (std::ranges::adjacent_find(samples, std::ranges::greater_equal(), key) == samples.end())
    return;
  std::vector<Sample*> sorted;
  for (Sample& sample : samples) sorted.push_back(&sample);
  const auto key_of = [&key](const Sample* sample) { return key(*sample); };
  std::ranges::stable_sort(sorted, {}, key_of);
  for (auto first = sorted.begin(); first != sorted.end();) {
    const auto end = std::find_if(first, sorted.end(), [&](const Sample* sample) {
      return key_of(sample) != key_of(*first);
    });
    const bool differ = std::any_of(std::next(first), end,
                                    [&](const Sample* sample) { return !same(*sample, **first); });
    for (; first != end; ++first)
      if (differ) refuse(**first);
  }
}

}  // namespace clearance
