// A header of lines is followed by the numbers of each element, in the header's order. The first
// fault ends the reading by an exception that does not leave this file.
#include "config/mesh/ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>
#include <utility>

namespace clearance {
namespace {

// Thrown and caught inside this file.
struct BadPly {
  std::string reason;
};

enum class Type : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

constexpr std::array<std::pair<std::string_view, Type>, 16> kTypes = {{{"char", Type::kI8},
                                                                       {"int8", Type::kI8},
                                                                       {"uchar", Type::kU8},
                                                                       {"uint8", Type::kU8},
                                                                       {"short", Type::kI16},
                                                                       {"int16", Type::kI16},
                                                                       {"ushort", Type::kU16},
                                                                       {"uint16", Type::kU16},
                                                                       {"int", Type::kI32},
                                                                       {"int32", Type::kI32},
                                                                       {"uint", Type::kU32},
                                                                       {"uint32", Type::kU32},
                                                                       {"float", Type::kF32},
                                                                       {"float32", Type::kF32},
                                                                       {"double", Type::kF64},
                                                                       {"float64", Type::kF64}}};

enum class Format : std::uint8_t { kAscii, kLittleEndian, kBigEndian };

struct Property {
  std::string_view name;
  Type type;                            // of each number
  std::optional<Type> count_type = {};  // of a list's length, which stands before it
};

struct Element {
  std::string_view name;
  std::uint64_t count;
  std::vector<Property> properties;
};

struct Header {
  std::optional<Format> format;
  std::vector<Element> elements;
};

// Reads the words of a file, and the numbers behind its header.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  // Returns the words of the next line.
  std::vector<std::string_view> line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) throw BadPly{"its header has no end"};
    Reader words(rest_.substr(0, end));
    rest_.remove_prefix(end + 1);
    std::vector<std::string_view> found;
    for (auto word = words.word(); !word.empty(); word = words.word()) found.push_back(word);
    return found;
  }

  double number(Type type, Format format) {
    if (format == Format::kAscii) return ascii(type);
    switch (type) {
      case Type::kI8:
        return binary<std::int8_t>(format);
      case Type::kU8:
        return binary<std::uint8_t>(format);
      case Type::kI16:
        return binary<std::int16_t>(format);
      case Type::kU16:
        return binary<std::uint16_t>(format);
      case Type::kI32:
        return binary<std::int32_t>(format);
      case Type::kU32:
        return binary<std::uint32_t>(format);
      case Type::kF32:
        return static_cast<double>(binary<float>(format));
      case Type::kF64:
        return binary<double>(format);
    }
    return 0.0;
  }

  [[nodiscard]] bool is_at_end() const {
    return rest_.find_first_not_of(std::string_view(" \t\r\n\0", 5)) == std::string_view::npos;
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r\n";

  // Returns an empty word at the end.
  std::string_view word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    const std::size_t end = std::min(rest_.find_first_of(kBlanks), rest_.size());
    const std::string_view found = rest_.substr(0, end);
    rest_.remove_prefix(end);
    return found;
  }

  double ascii(Type type) {
    const std::string_view text = word();
    double value = 0.0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty()) throw BadPly{"it is cut off"};
    if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
      throw BadPly{fmt::format("'{}' is no number", text.substr(0, 40))};
    }
    return type == Type::kF32 ? static_cast<double>(static_cast<float>(value)) : value;
  }

  template <class Number>
  Number binary(Format format) {
    if (rest_.size() < sizeof(Number)) throw BadPly{"it is cut off"};
    std::array<char, sizeof(Number)> bytes{};
    std::memcpy(bytes.data(), rest_.data(), sizeof(Number));
    const bool as_here =
        (std::endian::native == std::endian::little) == (format == Format::kLittleEndian);
    if (!as_here) std::ranges::reverse(bytes);
    rest_.remove_prefix(sizeof(Number));
    return std::bit_cast<Number>(bytes);
  }

  std::string_view rest_;
};

Type type_of(std::string_view name) {
  const auto found = std::ranges::find(kTypes, name, &std::pair<std::string_view, Type>::first);
  if (found == kTypes.end()) throw BadPly{fmt::format("'{}' is no type", name.substr(0, 40))};
  return found->second;
}

std::uint64_t count_of(std::string_view text) {
  std::uint64_t count = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), count);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    throw BadPly{fmt::format("'{}' is no number of elements", text.substr(0, 40))};
  }
  return count;
}

// Reads one line after the first; returns false at the end of the header.
bool read_header_line(const std::vector<std::string_view>& words, Header& header) {
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return true;
  if (words[0] == "end_header" && words.size() == 1) return false;
  if (words[0] == "format" && words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") header.format = Format::kAscii;
    if (words[1] == "binary_little_endian") header.format = Format::kLittleEndian;
    if (words[1] == "binary_big_endian") header.format = Format::kBigEndian;
  } else if (words[0] == "element" && words.size() == 3) {
    header.elements.push_back({words[1], count_of(words[2]), {}});
  } else if (words[0] == "property" && words.size() == 3 && !header.elements.empty()) {
    header.elements.back().properties.push_back({words[2], type_of(words[1])});
  } else if (words[0] == "property" && words.size() == 5 && words[1] == "list" &&
             !header.elements.empty()) {
    header.elements.back().properties.push_back({words[4], type_of(words[3]), type_of(words[2])});
  } else {
    throw BadPly{fmt::format("its header has a line '{} ...'", words[0].substr(0, 40))};
  }
  return true;
}

Header read_header(Reader& reader) {
  const std::vector<std::string_view> magic = reader.line();
  if (magic.size() != 1 || magic[0] != "ply") throw BadPly{"its first line is not 'ply'"};
  Header header;
  while (read_header_line(reader.line(), header)) {
  }
  if (!header.format) throw BadPly{"its header names no format that is known"};
  return header;
}

// Vertices, and triangles as three indices of vertices.
struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<double> corners;
};

// A count that no file of this size can hold fails at the end of the file: nothing is reserved for
// it.
std::vector<double> read_list(const Property& property, Format format, Reader& reader) {
  const double count = reader.number(*property.count_type, format);
  if (!(count >= 0.0) || count != std::floor(count)) {
    throw BadPly{fmt::format("a list has {} entries", count)};
  }
  std::vector<double> numbers;
  for (double i = 0.0; i < count; ++i) numbers.push_back(reader.number(property.type, format));
  return numbers;
}

void read_item(const Element& element, Format format, Reader& reader, Mesh& mesh) {
  Vec3 vertex = Vec3::Constant(std::nan(""));
  for (const Property& property : element.properties) {
    if (property.count_type) {
      const std::vector<double> list = read_list(property, format, reader);
      const bool corners = element.name == "face" &&
                           (property.name == "vertex_indices" || property.name == "vertex_index");
      for (std::size_t k = 1; corners && k + 1 < list.size(); ++k) {
        mesh.corners.insert(mesh.corners.end(), {list[0], list[k], list[k + 1]});
      }
      continue;
    }
    const double number = reader.number(property.type, format);
    const std::size_t axis = std::string_view("xyz").find(property.name);
    if (property.name.size() == 1 && axis < 3) vertex[static_cast<Eigen::Index>(axis)] = number;
  }
  if (element.name == "vertex") mesh.vertices.push_back(vertex);
}

// Elements of scanners and strips have surfaces, too, and a list of another name in a face as well.
void refuse_other_surfaces(const Header& header) {
  for (const Element& element : header.elements) {
    const bool is_surface = element.name == "tristrips" || element.name == "range_grid" ||
                            element.name == "patch" || element.name == "control_point";
    const bool has_corners = std::ranges::any_of(element.properties, [](const Property& each) {
      return each.count_type && each.name.starts_with("vert");
    });
    if (is_surface || (has_corners && element.name != "face")) {
      throw BadPly{fmt::format("its element '{}' is not read and could be a part of the surface",
                               element.name.substr(0, 40))};
    }
  }
}

const Vec3& vertex_of(const Mesh& mesh, double corner) {
  if (!(corner >= 0.0 && corner < static_cast<double>(mesh.vertices.size())) ||
      corner != std::floor(corner)) {
    throw BadPly{fmt::format("a face names vertex {} of {}", corner, mesh.vertices.size())};
  }
  return mesh.vertices[static_cast<std::size_t>(corner)];
}

std::vector<Triangle> triangles_of(const Mesh& mesh) {
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
    triangles.push_back({vertex_of(mesh, mesh.corners[i]), vertex_of(mesh, mesh.corners[i + 1]),
                         vertex_of(mesh, mesh.corners[i + 2])});
  }
  return triangles;
}

}  // namespace

std::variant<std::vector<Triangle>, MeshFault> ply_triangles(const std::string& bytes) {
  try {
    Reader reader(bytes);
    const Header header = read_header(reader);
    refuse_other_surfaces(header);
    Mesh mesh;
    for (const Element& element : header.elements) {
      if (element.properties.empty()) continue;
      for (std::uint64_t i = 0; i < element.count; ++i) {
        read_item(element, *header.format, reader, mesh);
      }
    }
    if (!reader.is_at_end()) throw BadPly{"it goes on behind the elements of its header"};
    return triangles_of(mesh);
  } catch (const BadPly& fault) {
    return MeshFault{fault.reason};
  }
}

}  // namespace clearance
