// MuJoCo 3: mj_geomDistance, which uses closed forms for some pairs of shapes and its own GJK and
// EPA for the others. It remembers nothing between queries, and keeps the vertices of meshes as
// floats.
#include <mujoco/mujoco.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "tools/bench/suite/rivals.hpp"

namespace clearance::bench {
namespace {

constexpr double kFarthest = 1e6;  // m, the limit of its search

struct FreeSpec {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
struct FreeModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct FreeData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

bool fits(const PlainBody& body) {
  using enum PlainBody::Kind;
  return body.kind != kCone && (body.kind != kHull || body.points.size() > 3);
}

void add_mesh(mjSpec* spec, const PlainBody& body, const std::string& name, mjsGeom* geom) {
  std::vector<float> vertices;
  for (const Numbers3& p : body.points) {
    for (const double x : p) vertices.push_back(static_cast<float>(x));
  }
  std::vector<int> triangles;
  for (const std::vector<int>& face : body.faces) {
    for (std::size_t i = 2; i < face.size(); ++i)
      triangles.insert(triangles.end(), {face[0], face[i - 1], face[i]});
  }
  mjsMesh* const mesh = mjs_addMesh(spec, nullptr);
  mjs_setName(mesh->element, name.c_str());
  mesh->inertia = mjMESH_INERTIA_CONVEX;
  mjs_setFloat(mesh->uservert, vertices.data(), static_cast<int>(vertices.size()));
  mjs_setInt(mesh->userface, triangles.data(), static_cast<int>(triangles.size()));
  mjs_setString(geom->meshname, name.c_str());
}

void add(mjSpec* spec, const PlainBody& body, const std::string& name) {
  mjsBody* const carrier = mjs_addBody(mjs_findBody(spec, "world"), nullptr);
  mjsGeom* const geom = mjs_addGeom(carrier, nullptr);
  const auto shape = [geom](mjtGeom type, const Numbers3& size) {
    geom->type = type;
    for (int i = 0; i < 3; ++i) geom->size[i] = size[static_cast<std::size_t>(i)];
  };
  using enum PlainBody::Kind;
  switch (body.kind) {
    case kBox:
      return shape(mjGEOM_BOX, body.half);
    case kSphere:
      return shape(mjGEOM_SPHERE, {body.radius});
    case kCapsule:
      return shape(mjGEOM_CAPSULE, {body.radius, body.half_length});
    case kCylinder:
      return shape(mjGEOM_CYLINDER, {body.radius, body.half_length});
    case kEllipsoid:
      return shape(mjGEOM_ELLIPSOID, body.half);
    case kHull:
    case kCone:
      break;
  }
  geom->type = mjGEOM_MESH;
  add_mesh(spec, body, name, geom);
}

class MujocoPair final : public RivalPair {
 public:
  MujocoPair(const PlainBody& a, const PlainBody& b) {
    const std::unique_ptr<mjSpec, FreeSpec> spec(mj_makeSpec());
    spec->option.ccd_tolerance = 1e-12;
    spec->option.ccd_iterations = 200;
    add(spec.get(), a, "a");
    add(spec.get(), b, "b");
    model_.reset(mj_compile(spec.get(), nullptr));
    if (!model_) throw std::runtime_error(mjs_getError(spec.get()));
    data_.reset(mj_makeData(model_.get()));
  }
  void forget() override {}
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override {
    place(0, world_from_a);
    place(1, world_from_b);
    mjtNum witnesses[6];
    return mj_geomDistance(model_.get(), data_.get(), 0, 1, kFarthest, witnesses);
  }

 private:
  // mj_compile() moves a mesh into the frame of its inertia, which geom_pos and geom_quat give in
  // the frame of the body.
  void place(int geom, const PlainPose& pose) {
    const mjtNum* const own = &model_->geom_quat[4 * geom];
    mjtNum position[3], quaternion[4];
    mju_rotVecQuat(position, &model_->geom_pos[3 * geom], pose.quaternion.data());
    mju_mulQuat(quaternion, pose.quaternion.data(), own);
    for (int i = 0; i < 3; ++i) {
      data_->geom_xpos[3 * geom + i] = position[i] + pose.position[static_cast<std::size_t>(i)];
    }
    mju_quat2Mat(&data_->geom_xmat[9 * geom], quaternion);
  }

  std::unique_ptr<mjModel, FreeModel> model_;
  std::unique_ptr<mjData, FreeData> data_;
};

}  // namespace

std::vector<Rival> mujoco_rivals() {
  return {{"MuJoCo", "3, doubles, 1e-12, meshes in floats; no warm start; EPA", true,
           [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
             if (!fits(a) || !fits(b)) return nullptr;
             return std::make_unique<MujocoPair>(a, b);
           }}};
}

}  // namespace clearance::bench
