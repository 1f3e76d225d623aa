#include "config/scene/contact.hpp"

#include <algorithm>

#include "config/scene/scene.hpp"

namespace clearance {

std::vector<ContactPair> contact_pairs(const Scene& scene) {
  std::vector<ContactPair> found;
  for (std::uint32_t contact = 0; contact < scene.contacts.size(); ++contact) {
    for (const std::uint32_t pair : scene.contacts[contact].pairs) found.push_back({contact, pair});
  }
  std::ranges::sort(found, {}, &ContactPair::pair);
  return found;
}

}  // namespace clearance
