// V-Clip 1.0: features of the last query, poses as matrices if it was compiled so, no hash table.
#include <memory>
#include <type_traits>
#include <vector>

#include "tools/bench/suite/rivals.hpp"
// V-Clip's header has names of std without including all that it needs.
using namespace std;  // NOLINT
#include <vclip.h>

namespace clearance::bench {
namespace {

// Faces and edges point into the hull's own lists, so it stays where it is made.
class Hull {
 public:
  explicit Hull(const PlainBody& body) {
    for (const Numbers3& p : body.points) {
      vertices_.push_back(hull_.addVertex("", Vclip::Vect3(p[0], p[1], p[2])));
    }
    for (const std::vector<int>& face : body.faces) {
      std::vector<Vclip::Vertex*> corners;
      for (const int i : face) corners.push_back(vertices_[static_cast<std::size_t>(i)]);
      hull_.addFace("", corners);
    }
  }
  Hull(const Hull&) = delete;
  Hull& operator=(const Hull&) = delete;
  [[nodiscard]] const Vclip::Polyhedron* get() const { return &hull_; }
  // A vertex is a feature, but the base class is private: only this form of the cast passes it.
  [[nodiscard]] const Vclip::Feature* start() const { return (const Vclip::Feature*)vertices_[0]; }

 private:
  Vclip::Polyhedron hull_;
  std::vector<Vclip::Vertex*> vertices_;
};

Vclip::VclipPose pose_of(const PlainPose& plain) {
  const auto& [w, x, y, z] = plain.quaternion;
  const Vclip::Vect3 position(plain.position[0], plain.position[1], plain.position[2]);
  const Vclip::Quat rotation(w, x, y, z);
  if constexpr (std::is_same_v<Vclip::VclipPose, Vclip::MatX>) {
    return {Vclip::Mat3(rotation), position};
  } else {
    return {rotation, position};
  }
}

class VclipPair final : public RivalPair {
 public:
  VclipPair(const PlainBody& a, const PlainBody& b) : a_(a), b_(b) { VclipPair::forget(); }
  void forget() override {
    feature_a_ = a_.start();
    feature_b_ = b_.start();
  }
  double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) override {
    Vclip::VclipPose b_from_a, a_from_b;
    b_from_a.invert(pose_of(world_from_b));
    b_from_a.postmult(pose_of(world_from_a));
    a_from_b.invert(b_from_a);
    Vclip::Vect3 on_a, on_b;
    return Vclip::Polyhedron::vclip(a_.get(), b_.get(), b_from_a, a_from_b, feature_a_, feature_b_,
                                    on_a, on_b);
  }

 private:
  Hull a_, b_;
  const Vclip::Feature *feature_a_ = nullptr, *feature_b_ = nullptr;
};

}  // namespace

std::vector<Rival> vclip_rivals() {
  const bool matrices = std::is_same_v<Vclip::VclipPose, Vclip::MatX>;
  return {{"V-Clip",
           std::string("1.0, doubles, last features, no hash; poses as ") +
               (matrices ? "matrices" : "quaternions"),
           false, [](const PlainBody& a, const PlainBody& b) -> std::unique_ptr<RivalPair> {
             if (a.points.empty() || b.points.empty()) return nullptr;
             return std::make_unique<VclipPair>(a, b);
           }}};
}

}  // namespace clearance::bench
