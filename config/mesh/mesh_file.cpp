// A mesh file is bytes of unknown origin, and some bytes crash the library that reads them. It runs
// in a child process, and its answer is checked once more. Vertices and triangles are sorted and
// made unique, so that the result does not depend on the order of faces in the file.
#include "config/mesh/mesh_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include "config/mesh/child_work.hpp"
#include "config/mesh/mesh_import.hpp"
#include "config/text/printable.hpp"

namespace clearance {
namespace {

// The formats that robots come with, and on which tests/config/mesh/mesh_mutation_test.cpp was
// tried.
constexpr std::array<std::string_view, 4> kFormats = {"stl", "obj", "ply", "dae"};

// Assimp never finishes some damaged files; good ones take it 0.003 to 0.03 s a MiB.
unsigned seconds_for(std::size_t bytes) { return 2 + static_cast<unsigned>(bytes >> 20); }

// The first byte of the child's answer.
constexpr char kMesh = 'm', kFault = 'f';
const Vec3 kNoColour(-1.0, -1.0, -1.0);

// Any order serves, as long as it depends on the coordinates only.
bool lexicographic(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Numbers vertices in their order; each triangle starts at its lowest number.
TriangleMesh indexed(const std::vector<Triangle>& triangles) {
  TriangleMesh mesh;
  for (const Triangle& t : triangles) mesh.vertices.insert(mesh.vertices.end(), t.begin(), t.end());
  std::sort(mesh.vertices.begin(), mesh.vertices.end(), lexicographic);
  mesh.vertices.erase(std::unique(mesh.vertices.begin(), mesh.vertices.end()), mesh.vertices.end());
  const auto index_of = [&](const Vec3& v) {
    return static_cast<std::uint32_t>(
        std::lower_bound(mesh.vertices.begin(), mesh.vertices.end(), v, lexicographic) -
        mesh.vertices.begin());
  };
  for (const Triangle& t : triangles) {
    std::array<std::uint32_t, 3> corners = {index_of(t[0]), index_of(t[1]), index_of(t[2])};
    std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
    mesh.triangles.push_back(corners);
  }
  std::ranges::sort(mesh.triangles);
  const auto again = std::ranges::unique(mesh.triangles);
  mesh.triangles.erase(again.begin(), again.end());
  return mesh;
}

template <class Item>
void append(const std::vector<Item>& items, std::string& bytes) {
  const std::uint64_t count = items.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(items.data()), count * sizeof(Item));
}

// Returns false when the bytes end too early.
template <class Item>
bool take(std::string_view& bytes, std::vector<Item>& items) {
  std::uint64_t count = 0;
  if (bytes.size() < sizeof count) return false;
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes.remove_prefix(sizeof count);
  if (count == 0 || count > bytes.size() / sizeof(Item)) return false;
  items.resize(count);
  std::memcpy(static_cast<void*>(items.data()), bytes.data(), count * sizeof(Item));
  bytes.remove_prefix(count * sizeof(Item));
  return true;
}

enum class Colours : std::uint8_t { kJoined, kApart };

void append(const std::optional<Vec3>& colour, const TriangleMesh& mesh, std::string& bytes) {
  append(std::vector{colour.value_or(kNoColour)}, bytes);
  append(mesh.vertices, bytes);
  append(mesh.triangles, bytes);
}
bool take(std::string_view& bytes, ColouredMesh& mesh) {
  std::vector<Vec3> colour;
  if (!take(bytes, colour) || colour.size() != 1) return false;
  if (colour[0] != kNoColour) mesh.colour = colour[0];
  return take(bytes, mesh.mesh.vertices) && take(bytes, mesh.mesh.triangles);
}

// Runs in the child.
std::string import_into_bytes(const std::string& bytes, const std::string& format,
                              Colours colours) {
  auto result = import_mesh(bytes, format);
  if (const auto* fault = std::get_if<MeshFault>(&result)) return kFault + fault->reason;
  auto& all = std::get<std::vector<ColouredTriangles>>(result);
  std::string said(1, kMesh);
  std::vector<Triangle> joined;
  for (const auto& [colour, triangles] : all) {
    for (const Triangle& t : triangles) {
      if (!std::ranges::all_of(t, [](const Vec3& v) { return v.allFinite(); })) {
        return std::string(1, kFault) + "a vertex is not finite";
      }
    }
    if (colours == Colours::kJoined) {
      joined.insert(joined.end(), triangles.begin(), triangles.end());
    } else {
      append(colour, indexed(triangles), said);
    }
  }
  if (colours == Colours::kJoined) append({}, indexed(joined), said);
  return said;
}

// Runs in the parent. A child that was corrupted by its input may answer anything.
std::variant<std::vector<ColouredMesh>, MeshFault> taken(const std::string& said) {
  if (said.starts_with(kFault)) return MeshFault{excerpt(std::string_view(said).substr(1))};
  const MeshFault no_answer{"the library that reads it gave no answer"};
  if (!said.starts_with(kMesh)) return no_answer;
  std::vector<ColouredMesh> all;
  std::string_view left = std::string_view(said).substr(1);
  do {
    ColouredMesh& next = all.emplace_back();
    if (!take(left, next)) return no_answer;
    for (const auto& corners : next.mesh.triangles) {
      if (*std::ranges::max_element(corners) >= next.mesh.vertices.size()) return no_answer;
    }
  } while (!left.empty());
  return all;
}

// Returns "stl" for "STL" or ".STL".
std::string format_of(const std::string& extension) {
  std::string format = extension.substr(extension.starts_with('.') ? 1 : 0);
  std::ranges::transform(format, format.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return format;
}

std::variant<std::vector<ColouredMesh>, MeshFault> read(const std::string& bytes,
                                                        const std::string& extension,
                                                        Colours colours) {
  const std::string format = format_of(extension);
  if (std::ranges::find(kFormats, format) == kFormats.end()) {
    return MeshFault{fmt::format("its format is none of {}", fmt::join(kFormats, ", "))};
  }
  const ChildWork work =
      in_child([&] { return import_into_bytes(bytes, format, colours); },
               {.cpu_s = seconds_for(bytes.size()), .wall_s = 30 * seconds_for(bytes.size())});
  if (!work.fault.empty()) return MeshFault{"the library that reads it " + work.fault};
  return taken(work.bytes);
}

}  // namespace

std::variant<TriangleMesh, MeshFault> read_mesh(const std::string& bytes,
                                                const std::string& extension) {
  auto result = read(bytes, extension, Colours::kJoined);
  if (auto* const fault = std::get_if<MeshFault>(&result)) return std::move(*fault);
  return std::move(std::get<std::vector<ColouredMesh>>(result).front().mesh);
}

std::variant<std::vector<ColouredMesh>, MeshFault> read_coloured_mesh(
    const std::string& bytes, const std::string& extension) {
  return read(bytes, extension, Colours::kApart);
}

}  // namespace clearance
