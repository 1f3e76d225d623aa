// A mesh file is bytes of unknown origin, read by a library that some of them crash: it runs in a
// child process, and what comes back is checked once more. The vertices are sorted and made unique,
// so that the result does not depend on the order of faces in the file.
#include "config/mesh_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "config/child_work.hpp"
#include "config/mesh_import.hpp"
#include "config/utf8.hpp"

namespace clearance {
namespace {

// What robots come with, and what the mutations of tests/config/mesh_mutation_test.cpp were tried
// on.
constexpr std::array<std::string_view, 4> kFormats = {"stl", "obj", "ply", "dae"};

// Far beyond any mesh that describes a robot; an endless file ends here.
constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;

// Assimp reads some damaged files for ever; good ones take it 0.003 to 0.03 s a MiB.
unsigned seconds_for(std::size_t bytes) { return 2 + static_cast<unsigned>(bytes >> 20); }

// The first byte of what the child says.
constexpr char kVertices = 'v', kFault = 'f';

// Any order serves that depends on the coordinates only.
bool lexicographic(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// In the child.
std::string import_into_bytes(const std::string& bytes, const std::string& format) {
  auto result = import_mesh(bytes, format);
  if (const auto* fault = std::get_if<MeshFault>(&result)) return kFault + fault->reason;
  auto& vertices = std::get<std::vector<Vec3>>(result);
  if (std::ranges::any_of(vertices, [](const Vec3& v) { return !v.allFinite(); })) {
    return std::string(1, kFault) + "a vertex is not finite";
  }
  std::sort(vertices.begin(), vertices.end(), lexicographic);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::string said(1, kVertices);
  said.append(reinterpret_cast<const char*>(vertices.data()), vertices.size() * sizeof(Vec3));
  return said;
}

// In the parent. A child that was led astray may say anything.
std::variant<std::vector<Vec3>, MeshFault> taken(const std::string& said) {
  if (said.starts_with(kFault)) return MeshFault{printable(said.substr(1))};
  const std::size_t count = said.empty() ? 0 : (said.size() - 1) / sizeof(Vec3);
  if (!said.starts_with(kVertices) || count == 0 || said.size() != 1 + count * sizeof(Vec3)) {
    return MeshFault{"the library that reads it gave no answer"};
  }
  std::vector<Vec3> vertices(count);
  std::memcpy(static_cast<void*>(vertices.data()), said.data() + 1, count * sizeof(Vec3));
  return vertices;
}

// "STL" of "x.STL" or ".STL", in lower case and without the dot.
std::string format_of(const std::string& extension) {
  std::string format = extension.substr(extension.starts_with('.') ? 1 : 0);
  std::ranges::transform(format, format.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return format;
}

}  // namespace

// The whole file, so that its bytes can go into the revision and be parsed without reading it
// again.
std::variant<std::string, MeshFault> read_bytes(const std::string& path) {
  std::error_code fault;
  if (std::filesystem::is_directory(path, fault))
    return MeshFault{fmt::format("'{}' is a directory", path)};
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return MeshFault{fmt::format("'{}' cannot be opened: {}", path, std::strerror(errno))};
  std::string bytes;
  std::array<char, 1 << 16> piece;
  while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0) {
    bytes.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > kMaxFileBytes) {
      return MeshFault{fmt::format("'{}' has more than {} MiB", path, kMaxFileBytes >> 20)};
    }
  }
  if (stream.bad())
    return MeshFault{fmt::format("'{}' cannot be read: {}", path, std::strerror(errno))};
  return bytes;
}

std::variant<std::vector<Vec3>, MeshFault> mesh_vertices(const std::string& bytes,
                                                         const std::string& extension) {
  const std::string format = format_of(extension);
  if (std::ranges::find(kFormats, format) == kFormats.end()) {
    return MeshFault{fmt::format("its format is none of {}", fmt::join(kFormats, ", "))};
  }
  const ChildWork work =
      in_child([&] { return import_into_bytes(bytes, format); },
               {.cpu_s = seconds_for(bytes.size()), .wall_s = 30 * seconds_for(bytes.size())});
  if (!work.fault.empty()) return MeshFault{"the library that reads it " + work.fault};
  return taken(work.bytes);
}

}  // namespace clearance
