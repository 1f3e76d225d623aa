// The file is read word by word, as MoveIt does; the names of the scene and of each object are
// whole lines. The first fault ends the reading.
#include "config/urdf/planning_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "config/decomposition/part_limits.hpp"
#include "config/decomposition/plate.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMostInList = 1'000'000;  // shapes of an object, vertices of a mesh

// Thrown inside this file only.
struct Fault {
  PlanningSceneFault fault;
};

class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  [[noreturn]] void fail(const std::string& reason) const { throw Fault{{line_, reason}}; }

  // Returns the rest of this line, without blanks around it.
  std::string rest_of_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end;
    while (!line.empty() && is_blank(line.front())) line.remove_prefix(1);
    while (!line.empty() && is_blank(line.back())) line.remove_suffix(1);
    return std::string(line);
  }

  // Returns an empty word at the end of the file.
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  // Counts the words of the next line that has some.
  std::size_t words_in_line() {
    skip_blanks();
    std::size_t count = 0;
    bool in_word = false;
    for (std::size_t i = at_; i < text_.size() && text_[i] != '\n'; ++i) {
      if (!is_blank(text_[i]) && !in_word) ++count;
      in_word = !is_blank(text_[i]);
    }
    return count;
  }

  double number(const char* what) {
    const std::string_view found = word();
    double value = 0.0;
    const auto result = std::from_chars(found.data(), found.data() + found.size(), value);
    if (result.ec == std::errc() && result.ptr == found.data() + found.size() &&
        std::isfinite(value)) {
      return value;
    }
    fail(fmt::format("found '{}'; expected {}", found, what));
  }

  std::size_t count(const char* what) {
    const double value = number(what);
    if (value < 0.0 || value != std::floor(value) || value > static_cast<double>(kMostInList))
      fail(fmt::format("found {}; expected {}: a whole number up to {}", value, what, kMostInList));
    return static_cast<std::size_t>(value);
  }

  // MoveIt writes unit quaternions in six digits: they are normalised again.
  Pose pose() {
    Pose pose;
    for (int i = 0; i < 3; ++i) pose.position[i] = number("a position in m");
    for (int i = 0; i < 4; ++i)
      pose.orientation.coeffs()[i] = number("a quaternion x y z w of unit length");
    const double length = pose.orientation.norm();
    if (!(std::abs(length - 1.0) < 1e-3))
      fail(fmt::format("found a quaternion of length {:.6f}; expected 1", length));
    pose.orientation.normalize();
    return pose;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }
  void skip_blanks() {
    for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) line_ += text_[at_] == '\n';
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

// A mesh becomes its convex hull, and a flat one a plate.
ShapeResult read_mesh(Words& words) {
  const std::size_t vertices = words.count("how many vertices the mesh has");
  const std::size_t triangles = words.count("how many triangles the mesh has");
  std::vector<Vec3> points(vertices);
  for (Vec3& point : points) {
    for (int i = 0; i < 3; ++i) point[i] = words.number("a vertex in m");
  }
  for (std::size_t i = 0; i < 3 * triangles; ++i)
    static_cast<void>(words.count("the vertex of a triangle"));
  return polyhedron_from_vertices(with_volume(points, PartLimits{}.plate));
}

// Reads a x + b y + c z + d = 0, a half-space that is solid below.
ShapeResult read_plane(Words& words) {
  Vec3 normal;
  for (int i = 0; i < 3; ++i) normal[i] = words.number("a plane a b c d");
  const double d = words.number("a plane a b c d");
  if (!(normal.norm() > 0.0)) words.fail("found a plane without a normal; expected a b c d");
  const HalfSpace row{normal, -d};
  return polyhedron_from_halfspaces({&row, 1});
}

ShapeResult read_shape(Words& words, const std::string& kind) {
  if (kind == "box") {
    Vec3 size;
    for (int i = 0; i < 3; ++i) size[i] = words.number("the size of a box in m");
    return box(0.5 * size);
  }
  if (kind == "sphere") return point(Vec3::Zero(), words.number("a radius in m"));
  if (kind == "cylinder" || kind == "cone") {
    const double radius = words.number("a radius in m");
    const double half = 0.5 * words.number("a length in m");
    return kind == "cone" ? cone(radius, half) : cylinder(radius, half);
  }
  if (kind == "mesh") return read_mesh(words);
  if (kind == "plane") return read_plane(words);
  words.fail(fmt::format(
      "found the shape '{}'; expected box, sphere, cylinder, cone, mesh or plane", kind));
}

Part read_part(Words& words, std::size_t place) {
  const std::string kind(words.word());
  ShapeResult shape = read_shape(words, kind);
  if (const auto* error = std::get_if<ShapeError>(&shape)) {
    words.fail(fmt::format("found a {} that is not a solid convex body: {}; expected one", kind,
                           error->reason));
  }
  Part part{fmt::format("{}{}", kind, place), std::get<ConvexBody>(std::move(shape)), words.pose()};
  for (int i = 0; i < 4; ++i) static_cast<void>(words.number("a colour r g b a"));
  return part;
}

Object read_object(Words& words) {
  Object object;
  object.name = words.rest_of_line();
  object.fixed = true;
  object.max_speed = 0.0;
  const bool has_pose = words.words_in_line() > 1;
  if (has_pose) object.world_from_object = words.pose();
  const std::size_t shapes = words.count("how many shapes the object has");
  for (std::size_t i = 0; i < shapes; ++i) object.parts.push_back(read_part(words, i));
  const std::size_t subframes = has_pose ? words.count("how many subframes the object has") : 0;
  for (std::size_t i = 0; i < subframes; ++i) {
    static_cast<void>(words.word());
    static_cast<void>(words.rest_of_line());
    static_cast<void>(words.pose());
  }
  return object;
}

// Adds one note for each kind of shape.
void note_shapes(PlanningScene& scene) {
  std::string meshes, planes;
  for (const Object& object : scene.objects) {
    for (const Part& part : object.parts) {
      if (part.name.starts_with("mesh")) meshes += (meshes.empty() ? "" : ", ") + object.name;
      if (part.name.starts_with("plane")) planes += (planes.empty() ? "" : ", ") + object.name;
    }
  }
  if (!meshes.empty())
    scene.notes.push_back(fmt::format("meshes are their convex hulls: {}", meshes));
  if (!planes.empty()) {
    scene.notes.push_back(
        fmt::format("planes are solid on the side that their normals point away from: {}", planes));
  }
}

PlanningScene read(Words& words) {
  PlanningScene scene;
  scene.name = words.rest_of_line();
  for (;;) {
    const std::string_view mark = words.word();
    if (mark == ".") {
      const std::string_view more = words.word();
      if (!more.empty())
        words.fail(fmt::format("found '{}' behind the '.' that ends a scene", more));
      break;
    }
    if (mark != "*") {
      words.fail(
          fmt::format("found '{}'; expected '* NAME' of an object, or '.' at the end, as in a "
                      ".scene file (YAML has to be in a .yaml file)",
                      mark));
    }
    scene.objects.push_back(read_object(words));
    if (scene.objects.back().parts.empty()) scene.objects.pop_back();
  }
  note_shapes(scene);
  return scene;
}

}  // namespace

std::variant<PlanningScene, PlanningSceneFault> read_planning_scene(std::string_view text) {
  Words words(text);
  try {
    return read(words);
  } catch (const Fault& fault) {
    return fault.fault;
  }
}

}  // namespace clearance
