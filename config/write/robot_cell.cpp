// Links with collision shapes become objects. The pairs are all of one group with itself, less the
// SRDF's disabled ones, or, without an SRDF, less the neighbours. Faults are kept and returned
// instead of a cell with a gap.
#include "config/write/robot_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "config/text/file_bytes.hpp"
#include "config/urdf/planning_scene.hpp"
#include "config/urdf/robot_exceptions.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/yaml/yaml_emitter.hpp"
#include "core/pose.hpp"

namespace clearance {
namespace {

// An identity pose is not written: the default of a cell file is the same.
bool is_identity(const UrdfOrigin& origin) {
  return origin.xyz == Vec3::Zero() && origin.rpy == Vec3::Zero() && !origin.quaternion;
}

void emit_quaternion(YAML::Emitter& out, const Eigen::Quaterniond& q) {
  out << YAML::Key << "quaternion" << YAML::Value;
  emit_list(out, shortest(q.x()), shortest(q.y()), shortest(q.z()), shortest(q.w()));
}

// Emits one cell, section by section, into one YAML emitter.
class RobotCellWriter {
 public:
  RobotCellWriter(const RobotCellOptions& options, UrdfRobot robot, std::optional<Srdf> srdf)
      : options_(options),
        robot_(std::move(robot)),
        srdf_(std::move(srdf)),
        group_(options.group.empty() ? robot_.name : options.group),
        meshes_({options.urdf, options.packages}, PackagesFrom::kCommandLine),
        notes_(robot_.notes) {}

  std::variant<RobotCell, UrdfFaults> write();

 private:
  void find_fixed_links();
  void emit_head();
  void emit_object(const UrdfLink& link);
  void emit_shape(const UrdfCollision& collision);
  void emit_scenes();
  void emit_pairs();
  void emit_exceptions();
  std::string mesh_path(const UrdfMesh& mesh);

  const RobotCellOptions& options_;
  UrdfRobot robot_;
  std::optional<Srdf> srdf_;
  std::string group_;
  LinkNames shaped_;                   // links with collision shapes
  std::map<std::string, Pose> fixed_;  // links that never move, in the world
  YAML::Emitter out_;
  MeshFinder meshes_;
  std::vector<std::string> notes_;
  // Faults are kept and not thrown, as the emitter is in the middle of a document.
  UrdfFaults faults_;
};

// Finds the root and all links that fixed joints join to it. The URDF is a tree, so each round
// fixes the children of the last.
void RobotCellWriter::find_fixed_links() {
  if (!options_.fixed_base) return;
  std::set<std::string> children;
  for (const UrdfJoint& joint : robot_.joints) children.insert(joint.child);
  for (const UrdfLink& link : robot_.links) {
    if (!children.contains(link.name)) fixed_[link.name] = Pose{};
  }
  for (bool grown = true; grown;) {
    grown = false;
    for (const UrdfJoint& joint : robot_.joints) {
      if (joint.type != "fixed" || !fixed_.contains(joint.parent) || fixed_.contains(joint.child))
        continue;
      fixed_[joint.child] = compose(fixed_[joint.parent], pose_of(joint.parent_from_child));
      grown = true;
    }
  }
}

// Returns the path of the mesh, relative to the cell.
std::string RobotCellWriter::mesh_path(const UrdfMesh& mesh) {
  const auto path = meshes_.find(mesh, faults_);
  if (!path) return mesh.file;
  const auto directory = std::filesystem::absolute(options_.directory).lexically_normal();
  return path->lexically_relative(directory).string();
}

// Emits the shape's key and its value, in the map of its part.
void RobotCellWriter::emit_shape(const UrdfCollision& collision) {
  const auto* cylinder = std::get_if<UrdfCylinder>(&collision.shape);
  const auto* mesh = std::get_if<UrdfMesh>(&collision.shape);
  const auto* box = std::get_if<UrdfBox>(&collision.shape);
  const auto* capsule = std::get_if<UrdfCapsule>(&collision.shape);
  const char* const key = mesh != nullptr       ? "mesh"
                          : box != nullptr      ? "box"
                          : cylinder != nullptr ? "cylinder"
                          : capsule != nullptr  ? "capsule"
                                                : "sphere";
  out_ << YAML::Key << key;
  out_ << YAML::Value << YAML::Flow << YAML::BeginMap;
  if (mesh != nullptr) {
    out_ << YAML::Key << "file" << YAML::Value;
    emit_text(out_, mesh_path(*mesh));
    if (mesh->scale != Vec3::Ones()) {
      out_ << YAML::Key << "scale" << YAML::Value;
      emit(out_, mesh->scale);
    }
  } else if (box != nullptr) {
    out_ << YAML::Key << "size" << YAML::Value;
    emit(out_, box->size);
  } else if (cylinder != nullptr) {
    out_ << YAML::Key << "radius" << YAML::Value << shortest(cylinder->radius);
    out_ << YAML::Key << "length" << YAML::Value << shortest(cylinder->length);
  } else if (capsule != nullptr) {
    const Vec3 end(0.0, 0.0, 0.5 * capsule->length);
    out_ << YAML::Key << "from" << YAML::Value;
    emit(out_, -end);
    out_ << YAML::Key << "to" << YAML::Value;
    emit(out_, end);
    out_ << YAML::Key << "radius" << YAML::Value << shortest(capsule->radius);
  } else {
    out_ << YAML::Key << "radius" << YAML::Value
         << shortest(std::get<UrdfSphere>(collision.shape).radius);
  }
  out_ << YAML::EndMap;
}

// Emits one link: its name, its group, its pose if it never moves, and its collision shapes as
// parts.
void RobotCellWriter::emit_object(const UrdfLink& link) {
  out_ << YAML::BeginMap << YAML::Key << "name" << YAML::Value;
  emit_text(out_, link.name);
  out_ << YAML::Key << "groups" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  emit_text(out_, group_);
  out_ << YAML::EndSeq;
  if (const auto found = fixed_.find(link.name); found != fixed_.end()) {
    out_ << YAML::Key << "fixed" << YAML::Value << true;
    out_ << YAML::Key << "pose" << YAML::Value << YAML::Flow << YAML::BeginMap;
    out_ << YAML::Key << "xyz" << YAML::Value;
    emit(out_, found->second.position);
    emit_quaternion(out_, found->second.orientation);
    out_ << YAML::EndMap;
  }
  out_ << YAML::Key << "parts" << YAML::Value << YAML::BeginSeq;
  for (const UrdfCollision& collision : link.collisions) {
    out_ << YAML::BeginMap;
    emit_shape(collision);
    if (!is_identity(collision.link_from_shape)) {
      out_ << YAML::Key << "pose" << YAML::Value << YAML::Flow << YAML::BeginMap;
      out_ << YAML::Key << "xyz" << YAML::Value;
      emit(out_, collision.link_from_shape.xyz);
      if (const auto& q = collision.link_from_shape.quaternion) {
        emit_quaternion(out_, *q);
      } else {
        out_ << YAML::Key << "rpy" << YAML::Value;
        emit(out_, collision.link_from_shape.rpy);
      }
      out_ << YAML::EndMap;
    }
    out_ << YAML::EndMap;
  }
  out_ << YAML::EndSeq << YAML::EndMap;
}

// Emits [A, B] under "between".
void emit_between(YAML::Emitter& out, const std::string& a, const std::string& b) {
  out << YAML::Key << "between" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  emit_text(out, a);
  emit_text(out, b);
  out << YAML::EndSeq;
}

// Notes of the files are passed on; the reader of the cell reports a file with a fault.
void RobotCellWriter::emit_scenes() {
  if (options_.scenes.empty()) return;
  const auto directory = std::filesystem::absolute(options_.directory).lexically_normal();
  out_ << YAML::Key << "scenes" << YAML::Value << YAML::BeginSeq;
  for (const std::filesystem::path& scene : options_.scenes) {
    const auto path = std::filesystem::absolute(scene).lexically_normal();
    out_ << YAML::Flow << YAML::BeginMap << YAML::Key << "file" << YAML::Value;
    emit_text(out_, path.lexically_relative(directory).string());
    out_ << YAML::Key << "group" << YAML::Value;
    emit_text(out_, scene.stem().string());
    out_ << YAML::EndMap;
    const auto bytes = read_bytes(path.string());
    if (std::holds_alternative<FileFault>(bytes)) continue;
    const auto read = read_planning_scene(std::get<std::string>(bytes));
    if (const auto* planning = std::get_if<PlanningScene>(&read)) {
      for (const std::string& note : planning->notes)
        notes_.push_back(fmt::format("{}: {}", scene.filename().string(), note));
    }
  }
  out_ << YAML::EndSeq;
}

// The group against itself is every pair of links; it also meets each planning scene.
void RobotCellWriter::emit_pairs() {
  out_ << YAML::Key << "pairs" << YAML::Value << YAML::BeginSeq << YAML::Flow << YAML::BeginMap;
  emit_between(out_, group_, group_);
  out_ << YAML::EndMap;
  for (const std::filesystem::path& scene : options_.scenes) {
    out_ << YAML::Flow << YAML::BeginMap;
    emit_between(out_, group_, scene.stem().string());
    out_ << YAML::EndMap;
  }
  out_ << YAML::EndSeq;
}

// Emits both kinds of exceptions with their reasons.
void RobotCellWriter::emit_exceptions() {
  LinkNames fixed_links;
  for (const auto& [link, world_from_link] : fixed_) fixed_links.insert(link);
  const std::vector<SrdfDisabled> exceptions =
      srdf_ ? exceptions_of(*srdf_, shaped_, fixed_links, notes_)
            : neighbours_of(robot_, shaped_, fixed_links, notes_);
  if (exceptions.empty()) return;
  out_ << YAML::Key << "allowed_collisions" << YAML::Value
       << YAML::Comment(srdf_ ? "from the SRDF" : "without an SRDF: links that a joint joins")
       << YAML::BeginSeq;
  for (const SrdfDisabled& entry : exceptions) {
    out_ << YAML::Flow << YAML::BeginMap;
    emit_between(out_, entry.link_a, entry.link_b);
    out_ << YAML::Key << "reason" << YAML::Value;
    emit_text(out_, entry.reason);
    out_ << YAML::EndMap;
  }
  out_ << YAML::EndSeq;
}

// Emits name, units (URDF is in metres and radians) and defaults.
void RobotCellWriter::emit_head() {
  const std::string srdf =
      options_.srdf.empty() ? "" : fmt::format(" and {}", options_.srdf.filename().string());
  out_ << YAML::Comment(fmt::format("Written by clearance-scene from {}{}.",
                                    options_.urdf.filename().string(), srdf));
  out_ << YAML::Key << "name" << YAML::Value;
  emit_text(out_, robot_.name);
  out_ << YAML::Key << "units" << YAML::Value << YAML::Flow << YAML::BeginMap;
  out_ << YAML::Key << "length" << YAML::Value << "m";
  out_ << YAML::Key << "angle" << YAML::Value << "rad" << YAML::EndMap;
  out_ << YAML::Key << "defaults" << YAML::Value << YAML::BeginMap;
  if (options_.max_speed > 0.0) {
    out_ << YAML::Key << "max_speed" << YAML::Value << shortest(options_.max_speed);
  }
  out_ << YAML::Key << "age_limit_ms" << YAML::Value << shortest(options_.age_limit_ms);
  if (options_.mesh_tolerance) {
    out_ << YAML::Key << "tolerance" << YAML::Value << shortest(*options_.mesh_tolerance);
  }
  if (options_.max_parts) out_ << YAML::Key << "max_parts" << YAML::Value << *options_.max_parts;
  out_ << YAML::EndMap;
}

// Fixed links come first: objects and exceptions depend on them.
std::variant<RobotCell, UrdfFaults> RobotCellWriter::write() {
  for (const UrdfLink& link : robot_.links) {
    if (!link.collisions.empty()) shaped_.insert(link.name);
  }
  find_fixed_links();
  if (srdf_) faults_ = faults_of(*srdf_, options_.srdf, robot_, options_.urdf);
  // Frames such as tool0 have no shapes; the note tells that they are not watched.
  std::string without;
  note_visuals(robot_, notes_);
  out_ << YAML::BeginMap;
  emit_head();
  out_ << YAML::Key << "objects" << YAML::Value << YAML::BeginSeq;
  for (const UrdfLink& link : robot_.links) {
    if (link.collisions.empty()) {
      without += fmt::format("{}{}", without.empty() ? "" : ", ", link.name);
    } else {
      emit_object(link);
    }
  }
  out_ << YAML::EndSeq;
  if (!without.empty()) {
    notes_.push_back(fmt::format("links without collision shapes left out: {}", without));
  }
  emit_scenes();
  emit_pairs();
  emit_exceptions();
  out_ << YAML::EndMap << YAML::Newline;
  if (!faults_.empty()) return faults_;
  return RobotCell{out_.c_str(), std::move(notes_)};
}

}  // namespace

// Both files are read even if the first has faults, so that one run reports all.
std::variant<RobotCell, UrdfFaults> robot_cell(const RobotCellOptions& options) {
  auto robot = read_urdf(options.urdf);
  std::optional<Srdf> srdf;
  UrdfFaults faults;
  if (!options.srdf.empty()) {
    auto read = read_srdf(options.srdf);
    if (auto* wrong = std::get_if<UrdfFaults>(&read)) faults = std::move(*wrong);
    if (auto* good = std::get_if<Srdf>(&read)) srdf = std::move(*good);
  }
  if (auto* wrong = std::get_if<UrdfFaults>(&robot)) {
    faults.insert(faults.begin(), wrong->begin(), wrong->end());
  }
  if (!faults.empty()) return faults;
  return RobotCellWriter(options, std::get<UrdfRobot>(std::move(robot)), std::move(srdf)).write();
}

}  // namespace clearance
