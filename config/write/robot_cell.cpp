// Links with collision shapes become objects. The pairs are all of one group with itself, less the
// SRDF's disabled ones, or, without an SRDF, less the neighbours. Faults are kept and returned
// instead of a cell with a gap.
#include "config/write/robot_cell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "config/urdf/robot_exceptions.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/yaml/yaml_emitter.hpp"

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
        meshes_({options.urdf, options.packages}, PackagesFrom::kCommandLine),
        notes_(robot_.notes) {}

  std::variant<RobotCell, UrdfFaults> write();

 private:
  void emit_head();
  void emit_object(const UrdfLink& link);
  void emit_shape(const UrdfCollision& collision);
  void emit_exceptions();
  std::string mesh_path(const UrdfMesh& mesh);

  const RobotCellOptions& options_;
  UrdfRobot robot_;
  std::optional<Srdf> srdf_;
  LinkNames shaped_;  // links with collision shapes
  YAML::Emitter out_;
  MeshFinder meshes_;
  std::vector<std::string> notes_;
  // Faults are kept and not thrown, as the emitter is in the middle of a document.
  UrdfFaults faults_;
};

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

// Emits one link: its name, its group, and its collision shapes as parts.
void RobotCellWriter::emit_object(const UrdfLink& link) {
  out_ << YAML::BeginMap << YAML::Key << "name" << YAML::Value;
  emit_text(out_, link.name);
  out_ << YAML::Key << "groups" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  emit_text(out_, robot_.name);
  out_ << YAML::EndSeq;
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

// Emits both kinds of exceptions with their reasons.
void RobotCellWriter::emit_exceptions() {
  const std::vector<SrdfDisabled> exceptions = srdf_ ? exceptions_of(*srdf_, shaped_, {}, notes_)
                                                     : neighbours_of(robot_, shaped_, {}, notes_);
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
  out_ << YAML::EndMap;
}

std::variant<RobotCell, UrdfFaults> RobotCellWriter::write() {
  for (const UrdfLink& link : robot_.links) {
    if (!link.collisions.empty()) shaped_.insert(link.name);
  }
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
  // The group against itself is every pair of links.
  out_ << YAML::Key << "pairs" << YAML::Value << YAML::BeginSeq << YAML::Flow << YAML::BeginMap;
  emit_between(out_, robot_.name, robot_.name);
  out_ << YAML::EndMap << YAML::EndSeq;
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
