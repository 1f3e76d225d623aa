// clearance.JointWriter and PoseWriter: monitor/client/client.hpp.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <list>
#include <string>
#include <utility>
#include <vector>

#include "monitor/client/client.hpp"
#include "tools/python/module/arrays.hpp"
#include "tools/python/module/live/connection.hpp"
#include "tools/python/module/live/live.hpp"

namespace clearance::python {
namespace {

std::int64_t stamp_of(const std::optional<std::int64_t>& stamp_ns) {
  return stamp_ns.value_or(client::now_ns());
}

void expect_finite(const Doubles& array, const char* name) {
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    if (!std::isfinite(array.at(i)))
      throw py::value_error(
          fmt::format("{}[{}]: found {}; expected a finite number", name, i, array.at(i)));
  }
}

template <class Parts>
bool wait_heard(Parts& parts, const std::optional<double>& timeout_s) {
  const Unlocked unlock;
  return wait_in_slices(timeout_s, [&](std::chrono::nanoseconds slice) {
    if (parts.writer.is_heard()) return true;
    dds_sleepfor(std::min<std::int64_t>(slice.count(), 5'000'000));
    return false;
  });
}

// Of two positions of one joint, or two poses of one object, none could be meant.
std::vector<std::string> each_once(std::vector<std::string> names, const char* what) {
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (std::find(names.begin(), name, *name) == name) continue;
    throw py::value_error(
        fmt::format("found the {0} '{1}' twice; expected each {0} once", what, *name));
  }
  return names;
}

struct JointParts {
  JointParts(SharedConnection joined, const std::string& source, std::vector<std::string> of)
      : connection(std::move(joined)), names(std::move(of)), writer(*connection, source, names) {}
  SharedConnection connection;
  std::vector<std::string> names;
  client::JointWriter writer;
};

class JointWriter : public Live<JointParts> {
 public:
  JointWriter(const std::string& source, std::vector<std::string> names,
              const SharedConnection& connection)
      : Live("JointWriter", connection_of(connection), source,
             each_once(std::move(names), "joint")) {}

  bool write(const py::object& positions, const py::object& velocities,
             const std::optional<std::int64_t>& stamp_ns, bool stopping) {
    const Use parts = use();
    const auto count = static_cast<py::ssize_t>(parts->names.size());
    const auto size = static_cast<std::size_t>(count);
    const Doubles at = doubles_of(positions, "positions", {count});
    expect_finite(at, "positions");
    if (velocities.is_none())
      return parts->writer.write({at.data(), size}, {}, stamp_of(stamp_ns), stopping);
    const Doubles speeds = doubles_of(velocities, "velocities", {count});
    expect_finite(speeds, "velocities");
    return parts->writer.write({at.data(), size}, {speeds.data(), size}, stamp_of(stamp_ns),
                               stopping);
  }
};

struct PoseParts {
  PoseParts(SharedConnection joined, const std::string& source, std::vector<std::string> names)
      : connection(std::move(joined)), catalogue(*connection), writer(*connection, source) {
    for (std::string& name : names) objects.emplace_back(catalogue, std::move(name));
  }
  SharedConnection connection;
  client::Catalogue catalogue;
  std::list<client::Object> objects;
  client::PoseWriter writer;
};

class PoseWriter : public Live<PoseParts> {
 public:
  PoseWriter(const std::string& source, std::vector<std::string> objects,
             const SharedConnection& connection)
      : Live("PoseWriter", connection_of(connection), source, checked(std::move(objects))) {}

  bool write(const py::object& poses, const py::object& twists,
             const std::optional<std::int64_t>& stamp_ns) {
    const Use parts = use();
    const auto count = static_cast<py::ssize_t>(parts->objects.size());
    const Doubles rows = doubles_of(poses, "poses", {count, 7});
    std::optional<Doubles> speeds;
    if (!twists.is_none()) speeds = doubles_of(twists, "twists", {count, 6});
    parts->catalogue.update();
    const std::uint64_t revision = parts->catalogue.revision();
    if (revision == 0) return false;
    std::vector<clearance_msg_ObjectPose> message;
    const std::int64_t held_ns = stamp_of(stamp_ns);
    py::ssize_t i = 0;
    for (client::Object& object : parts->objects) {
      const std::optional<std::uint32_t> id = object.id(revision);
      if (!id)
        throw py::key_error(fmt::format("the daemon's cell has no object '{}'", object.name()));
      const Pose pose = pose_in(rows.data(i, 0), "poses", i);
      const Eigen::Quaterniond& q = pose.orientation;
      clearance_msg_ObjectPose& one = message.emplace_back();
      one.object = *id;
      one.stamp_ns = held_ns;
      one.position = {pose.position.x(), pose.position.y(), pose.position.z()};
      one.orientation = {q.x(), q.y(), q.z(), q.w()};
      one.has_twist = speeds.has_value();
      if (speeds) {
        const double* v = speeds->data(i, 0);
        one.linear = {v[0], v[1], v[2]};
        one.angular = {v[3], v[4], v[5]};
      }
      ++i;
    }
    return parts->writer.write(message, revision);
  }

 private:
  static std::vector<std::string> checked(std::vector<std::string> objects) {
    if (objects.empty() || objects.size() > clearance_msg_kMaxPoses)
      throw py::value_error(fmt::format("objects: found {} names; expected 1 to {}", objects.size(),
                                        clearance_msg_kMaxPoses));
    return each_once(std::move(objects), "object");
  }
};

constexpr const char* kWaitHeard =
    "Waits until a daemon listens; False if none came within `timeout` s (None: no end). Ctrl-C "
    "ends it.";

}  // namespace

void add_writers(py::module_& module) {
  py::class_<JointWriter> joints(module, "JointWriter",
                                 "Sends joint states of robots of the cell.");
  joints
      .def(
          py::init<const std::string&, std::vector<std::string>, const SharedConnection&>(),
          py::arg("source"), py::arg("names"), py::arg("connection") = py::none(),
          R"(source: 1 to 32 bytes, of no other writer. names: of joints, as in the URDF, with the prefix
that the cell gives. Raises ValueError and DdsError.)")
      .def(
          "write", &JointWriter::write, py::arg("positions"), py::arg("velocities") = py::none(),
          py::arg("stamp_ns") = py::none(), py::arg("stopping") = false,
          R"(positions: (names,), rad or m. velocities: (names,), per second. stamp_ns: when they held;
None: now. stopping: the brakes act, and do so until these joints stand. Returns False if DDS did not take them. Raises ValueError for another shape or a number that
is not finite.)")
      .def(
          "wait_heard",
          [](JointWriter& self, const std::optional<double>& timeout) {
            return wait_heard(*self.use(), timeout_of(timeout));
          },
          py::arg("timeout") = py::none(), kWaitHeard)
      .def_property_readonly(
          "is_heard", [](JointWriter& self) { return self.use()->writer.is_heard(); },
          "True when a daemon listens.");
  add_closing(joints);
  py::class_<PoseWriter> poses(module, "PoseWriter", "Sends poses of moving objects of the cell.");
  poses
      .def(
          py::init<const std::string&, std::vector<std::string>, const SharedConnection&>(),
          py::arg("source"), py::arg("objects"), py::arg("connection") = py::none(),
          R"(source: 1 to 32 bytes, of no other writer. objects: their names in the cell. Raises ValueError
and DdsError.)")
      .def(
          "write", &PoseWriter::write, py::arg("poses"), py::arg("twists") = py::none(),
          py::arg("stamp_ns") = py::none(),
          R"(poses: (objects, 7), each x, y, z, and the quaternion x, y, z, w, in the world, m. twists:
(objects, 6), linear m/s and angular rad/s, along world axes. stamp_ns: when they held; None: now.

Returns False if no daemon has sent its names yet, or if DDS did not take the poses. Raises KeyError for
an object that the cell does not have, ValueError for another shape or a bad pose.)")
      .def(
          "wait_heard",
          [](PoseWriter& self, const std::optional<double>& timeout) {
            return wait_heard(*self.use(), timeout_of(timeout));
          },
          py::arg("timeout") = py::none(), kWaitHeard)
      .def_property_readonly(
          "is_heard", [](PoseWriter& self) { return self.use()->writer.is_heard(); },
          "True when a daemon listens.");
  add_closing(poses);
}

}  // namespace clearance::python
