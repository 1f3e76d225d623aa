#include "monitor/intake/message_form.hpp"

#include <bit>
#include <initializer_list>

#include "monitor/intake/digest.hpp"

namespace clearance {
namespace {

std::uint64_t digest_of(std::initializer_list<std::uint64_t> numbers) noexcept {
  Digest digest;
  for (const std::uint64_t number : numbers) digest.add(number);
  return digest.value();
}

}  // namespace

std::uint64_t digest_of_frame(std::string_view name) noexcept {
  if (name.starts_with('/')) name.remove_prefix(1);
  if (name.empty()) return 0;
  Digest digest;
  digest.add(name);
  return digest.value();
}

MessageForm form_of(std::string_view frame, const DepthImage& image) noexcept {
  return {digest_of_frame(frame), digest_of({static_cast<std::uint64_t>(image.format), image.width,
                                             image.height, image.step})};
}

MessageForm form_of(std::string_view frame, const PointsView& points) noexcept {
  const std::uint64_t width = points.height > 1 ? points.width : 0;
  return {digest_of_frame(frame),
          digest_of({width, points.height, points.point_step, points.x, points.y, points.z})};
}

MessageForm form_of(std::string_view frame, const OctomapView& map) noexcept {
  Digest digest;
  digest.add(map.id);
  digest.add(map.is_binary ? 1 : 0);
  digest.add(std::bit_cast<std::uint64_t>(map.resolution));
  return {digest_of_frame(frame), digest.value()};
}

}  // namespace clearance
