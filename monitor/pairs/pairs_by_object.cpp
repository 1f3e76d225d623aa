#include "monitor/pairs/pairs_by_object.hpp"

namespace clearance {

PairsByObject::PairsByObject(const Scene& scene)
    : first_(scene.objects.size() + 1, 0), pairs_(2 * scene.pairs.size()) {
  for (const ObjectPair& pair : scene.pairs) {
    ++first_[pair.first + 1];
    ++first_[pair.second + 1];
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) first_[i + 1] += first_[i];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    pairs_[next[scene.pairs[p].first]++] = p;
    pairs_[next[scene.pairs[p].second]++] = p;
  }
}

}  // namespace clearance
