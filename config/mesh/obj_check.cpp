#include "config/mesh/obj_check.hpp"

#include <fmt/format.h>

#include <string_view>

#include "config/text/words.hpp"

namespace clearance {
namespace {

constexpr std::string_view kBlanks = " \t\r\0";
constexpr std::string_view kKnown =
    "v vn vt f p l g o s mg usemtl mtllib usemap maplib lod bevel c_interp d_interp shadow_obj "
    "trace_obj";

}  // namespace

std::string fault_of_obj(const std::string& text) {
  std::string_view rest = text;
  bool goes_on = false;
  for (int number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
    const std::size_t begin = line.find_first_not_of(kBlanks);
    const std::size_t last = line.find_last_not_of(kBlanks);
    const bool was_continued = goes_on;
    goes_on = last != line.npos && line[last] == '\\';
    if (begin == line.npos || line[begin] == '#' || was_continued) continue;
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    if (has_word(kKnown, word)) continue;
    return fmt::format(
        "line {} begins with '{:.40}', which is not read and could be a part of the "
        "surface",
        number, word);
  }
  return "";
}

}  // namespace clearance
