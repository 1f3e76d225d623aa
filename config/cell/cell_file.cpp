// Parses the YAML into a tree that knows its lines, then reads it section by section into a Cell.
// Each reader reports a mistake and goes on with a default, so that one run finds every mistake. A
// Cell is returned only if there was none.
#include "config/cell/cell_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "config/cell/attachment_reader.hpp"
#include "config/cell/command_reader.hpp"
#include "config/cell/contact_reader.hpp"
#include "config/cell/dds_reader.hpp"
#include "config/cell/error_reader.hpp"
#include "config/cell/link_margins.hpp"
#include "config/cell/measured_steps.hpp"
#include "config/cell/object_reader.hpp"
#include "config/cell/pair_reader.hpp"
#include "config/cell/partner_reader.hpp"
#include "config/cell/planning_scene_reader.hpp"
#include "config/cell/plc_reader.hpp"
#include "config/cell/published_pairs.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/cell/ros_reader.hpp"
#include "config/cell/sensor_places.hpp"
#include "config/cell/sensor_reader.hpp"
#include "config/cell/shape_reader.hpp"
#include "config/cell/share_reader.hpp"
#include "config/cell/simulation_reader.hpp"
#include "config/cell/stop_demands.hpp"
#include "config/cell/timing_reader.hpp"
#include "config/cell/zone_reader.hpp"
#include "config/scene/refresh_share.hpp"
#include "config/scene/revision.hpp"
#include "config/text/file_bytes.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

void note_mesh_errors(ObjectList& list) {
  for (Object& object : list.objects) {
    const auto error = list.mesh_errors.find(object.name);
    if (error != list.mesh_errors.end()) object.mesh_error = error->second;
  }
}

// With what objects that questions attach need beside the pairs.
void fill(Scene& scene, ObjectList& list, RobotList& robots, PairList& pairs,
          const PairExceptions& by_matrices) {
  const auto note = [&](PairKey key) {
    scene.may_touch.push_back({first_of(key), second_of(key)});
  };
  for (const auto& [key, line] : by_matrices) note(key);
  for (const PairKey key : list.touching) note(key);
  scene.rules = std::move(pairs.rules);
  scene.exceptions = std::move(pairs.exceptions);
  scene.attachments = std::move(list.attachments);
  scene.pairs = std::move(pairs.pairs);
  scene.objects = std::move(list.objects);
  scene.robots = std::move(robots.robots);
  scene.variables = std::move(robots.variables);
}

// The sections of a cell, one function each.
class CellReader {
 public:
  CellReader(const std::filesystem::path& file, const CellOptions& options, MeshLibrary& meshes,
             ConvexShapes& known, Diagnostics& diagnostics, Revision& revision)
      : file_(file),
        options_(options),
        meshes_(meshes),
        known_(known),
        diagnostics_(diagnostics),
        revision_(revision) {}

  void read(const YamlNode& root, Cell& cell);

 private:
  std::optional<Units> read_units(const YamlNode& node);
  void read_objects_and_pairs(MapReader& map, const Quantities& quantities, Cell& cell);
  void settle_stops(const YamlNode* zones_node, RobotList& robots, const ObjectList& list,
                    const PairList& pairs, const std::vector<Zone>& zones);
  void publish_open(RobotList& robots, const ObjectList& list, PairList& pairs,
                    const std::vector<Zone>& zones);
  void refuse_frames_without_a_world(const YamlNode& root, const Cell& cell);
  void select_share(const YamlNode& root, Cell& cell);
  // This comes last: it needs every pair with its parts.
  void refuse_small_budget(const YamlNode& root, const Cell& cell);

  const std::filesystem::path& file_;
  const CellOptions& options_;
  MeshLibrary& meshes_;
  ConvexShapes& known_;
  Diagnostics& diagnostics_;
  Revision& revision_;
  TimingPlaces timing_;
  const YamlNode* ros_ = nullptr;  // likewise, here and below
  const YamlNode* shares_ = nullptr;
  const YamlNode* errors_ = nullptr;
};

// Both units are required: a default would silently be wrong for many cells.
std::optional<Units> CellReader::read_units(const YamlNode& node) {
  MapReader map(node, "the units", diagnostics_);
  const YamlNode* length_node = map.required("length");
  const YamlNode* angle_node = map.required("angle");
  map.refuse_unknown_keys();
  std::optional<LengthUnit> length;
  std::optional<AngleUnit> angle;
  if (length_node != nullptr) length = read_length_unit(*length_node, diagnostics_);
  if (angle_node != nullptr) angle = read_angle_unit(*angle_node, diagnostics_);
  if (!length || !angle) return std::nullopt;
  return Units{*length, *angle};
}

void CellReader::settle_stops(const YamlNode* zones_node, RobotList& robots, const ObjectList& list,
                              const PairList& pairs, const std::vector<Zone>& zones) {
  if (!diagnostics_.empty()) return;
  const StoppingRobots stopping(robots.robots, list.objects);
  refuse_unbounded_motion(stopping, robots, list, diagnostics_);
  use_carried_loads(list, robots, diagnostics_);
  if (zones_node != nullptr)
    refuse_zones_without_stops(*zones_node, stopping, zones, pairs.pairs, diagnostics_);
}

void CellReader::publish_open(RobotList& robots, const ObjectList& list, PairList& pairs,
                              const std::vector<Zone>& zones) {
  if (!diagnostics_.empty()) return;
  const std::string note =
      publish_open_pairs({list.objects, robots.robots, robots.variables}, zones, pairs);
  if (!note.empty() && !robots.robots.empty()) robots.robots.front().notes.push_back(note);
}

// Reads objects and robots, then pairs, then zones. Each list names entries of the one before, and
// is checked as far as that one could be read.
void CellReader::read_objects_and_pairs(MapReader& map, const Quantities& quantities, Cell& cell) {
  ObjectDefaults defaults;
  if (const YamlNode* node = map.optional("defaults")) defaults = read_defaults(*node, quantities);
  cell.scene.added_margin = defaults.margin;
  const YamlNode* templates_node = map.optional("templates");
  const YamlNode* robots_node = map.optional("robots");
  const YamlNode* scenes_node = map.optional("scenes");
  const YamlNode* sensors_node = map.optional("sensors");
  const YamlNode* margins_node = map.optional("margins");
  const YamlNode* objects_node = robots_node == nullptr && scenes_node == nullptr
                                     ? map.required("objects")
                                     : map.optional("objects");
  const YamlNode* pairs_node = map.required("pairs");
  const YamlNode* allowed_node = map.optional("allowed_collisions");
  const YamlNode* zones_node = map.optional("zones");
  const YamlNode* contacts_node = map.optional("contacts");
  const YamlNode* simulation_node = map.optional("simulation");
  shares_ = map.optional("shares");

  ObjectList list;
  ShapeReader shapes(quantities, meshes_, defaults.mesh_limits, known_);
  ObjectTemplates templates;
  if (templates_node != nullptr) templates = read_templates(*templates_node, quantities, shapes);
  if (objects_node != nullptr)
    list = read_objects(*objects_node, defaults, templates, quantities, shapes);
  if (scenes_node != nullptr)
    read_planning_scenes(*scenes_node, file_.parent_path(), defaults, quantities, shapes, revision_,
                         list);
  SensorList sensors;
  if (sensors_node != nullptr) sensors = read_sensors(*sensors_node, defaults, quantities, list);
  RobotList robots;
  if (robots_node != nullptr) {
    robots = read_robots(*robots_node, file_, defaults, quantities, shapes, revision_, list);
  } else if (objects_node == nullptr && scenes_node == nullptr) {
    list.names_known = false;
  }
  if (margins_node != nullptr) read_link_margins(*margins_node, robots, quantities, list);
  attach_objects(quantities, robots, list);
  mount_sensors(robots, list, quantities, sensors);
  errors_ = map.optional("errors");
  if (errors_ != nullptr) read_errors(*errors_, quantities, robots, list, cell.scene);
  PairExceptions by_matrices;
  allow_by_matrices(list, by_matrices);
  robots.may_touch.insert(robots.may_touch.end(), by_matrices.begin(), by_matrices.end());
  note_mesh_errors(list);
  if (options_.mesh_errors != nullptr) *options_.mesh_errors = std::move(list.mesh_errors);
  refuse_same_names(list, diagnostics_);
  refuse_too_many_sources(list, robots.variables, robots_node, diagnostics_);
  const std::string note = note_on_sources(list, robots.robots, robots.variables);
  if (!note.empty() && !robots.robots.empty()) robots.robots.front().notes.push_back(note);
  GroupIndex group_index(list, diagnostics_);
  if (ros_ != nullptr && cell.ros.moveit.adds_objects())
    group_index.declare(cell.ros.moveit.group, *ros_, "found MoveIt's messages");
  PairList pairs;
  pairs.complete = false;
  if (pairs_node != nullptr)
    pairs = read_pairs(*pairs_node, allowed_node, list, robots, group_index, diagnostics_);
  if (zones_node != nullptr)
    cell.scene.zones = read_zones(*zones_node, list, group_index, quantities, pairs);
  if (contacts_node != nullptr) {
    cell.scene.contacts = read_contacts(*contacts_node, list, robots.robots, cell.scene.zones,
                                        group_index, quantities, pairs);
  }
  settle_stops(zones_node, robots, list, pairs, cell.scene.zones);
  publish_open(robots, list, pairs, cell.scene.zones);
  const bool is_complete = pairs.complete && list.names_known;
  if (shares_ != nullptr && is_complete) {
    cell.shares.all = read_shares(*shares_, list.objects, pairs.pairs, cell.scene.zones,
                                  group_index, diagnostics_);
  }
  if (is_complete) group_index.refuse_unused_groups();
  if (simulation_node != nullptr)
    cell.simulation = read_simulation(*simulation_node, list, quantities);
  fill(cell.scene, list, robots, pairs, by_matrices);
  cell.scene.sensors = sensors.sensors;
  find_followed(timing_, diagnostics_, cell.scene);
  crop_sensors(sensors, diagnostics_, cell.scene);
}

// Reads the top level. Units come first, since every other section needs them.
void CellReader::read(const YamlNode& root, Cell& cell) {
  MapReader map(root, "a cell", diagnostics_);
  if (const YamlNode* name = map.required("name")) {
    cell.scene.name = read_name(*name, "the cell's name", diagnostics_).value_or("");
  }
  std::optional<Units> units;
  if (const YamlNode* node = map.required("units")) units = read_units(*node);
  // Without units, the rest is still read to find its mistakes.
  const Quantities quantities(units.value_or(Units{}), diagnostics_);
  timing_ = read_timing(map, quantities, cell.scene);
  if (const YamlNode* dds = map.optional("dds")) read_dds(*dds, cell, diagnostics_);
  ros_ = map.optional("ros2");
  if (ros_ != nullptr) read_ros(*ros_, quantities, cell.ros);
  if (const YamlNode* commands = map.optional("commands"))
    cell.commands = read_commands(*commands, file_.parent_path(), diagnostics_);
  if (const YamlNode* questions = map.optional("questions"))
    cell.questions = read_questions(*questions, diagnostics_);
  if (const YamlNode* capacity = map.optional("capacity"))
    cell.capacity = read_capacity(*capacity, diagnostics_);
  if (const YamlNode* partner = map.optional("partner"))
    cell.partner = read_partner(*partner, diagnostics_);
  read_objects_and_pairs(map, quantities, cell);
  if (errors_ != nullptr && diagnostics_.empty())
    refuse_large_angles(*errors_, cell.scene, diagnostics_);
  cell.plc = read_plc(map, file_.parent_path(), cell.scene, diagnostics_);
  map.refuse_unknown_keys();
  refuse_frames_without_a_world(root, cell);
  const auto is_person = [](const Robot& robot) { return robot.person.has_value(); };
  if (!cell.ros.moveit.tracked_bodies.empty() && !std::ranges::any_of(cell.scene.robots, is_person))
    diagnostics_.add(*ros_,
                     "found tracked_bodies without persons; expected robots with 'person', "
                     "one for each body that may be there at a time");
  if (diagnostics_.empty() && !options_.share.empty()) select_share(root, cell);
  if (diagnostics_.empty() && !meshes_.has_put_off()) refuse_small_budget(root, cell);
}

void CellReader::select_share(const YamlNode& root, Cell& cell) {
  const std::vector<Share>& all = cell.shares.all;
  const auto found = std::ranges::find(all, options_.share, &Share::name);
  if (found != all.end())
    return clearance::select_share(cell, static_cast<std::uint32_t>(found - all.begin()));
  std::vector<std::string> names;
  for (const Share& share : all) names.push_back(share.name);
  diagnostics_.add(
      shares_ == nullptr ? root : *shares_,
      names.empty()
          ? fmt::format("found no 'shares', and was asked for the share '{}'", options_.share)
          : fmt::format("found no share '{}'; expected {}{}", options_.share, one_of(names),
                        did_you_mean(options_.share, names)));
}

// The root frame cannot be guessed: while transforms are missing, any frame may be the root.
void CellReader::refuse_frames_without_a_world(const YamlNode& root, const Cell& cell) {
  if (!cell.ros.world_frame.empty()) return;
  std::vector<std::pair<std::string, std::string>> frames;  // by who follows them
  for (const Object& each : cell.scene.objects) frames.emplace_back(each.name, each.frame);
  for (const Robot& each : cell.scene.robots) frames.emplace_back(each.name, each.base.frame);
  for (const SimulatedFrame& each : cell.simulation.frames)
    frames.emplace_back("a mover", each.name);
  const auto found =
      std::ranges::find_if(frames, [](const auto& each) { return !each.second.empty(); });
  if (found == frames.end()) return;
  diagnostics_.add(root, fmt::format("found that '{}' follows the frame '{}', and no world_frame; "
                                     "expected the frame of tf that is the cell's world: ros2: "
                                     "{{world_frame: map}}",
                                     found->first, found->second));
}

// A budget that cannot refresh every pair in time would silently break the promise of refresh_s.
// A cell in shares is meant for daemons that each have one.
void CellReader::refuse_small_budget(const YamlNode& root, const Cell& cell) {
  const Scene& scene = cell.scene;
  RefreshShare share;
  if (cell.shares.all.empty() || cell.shares.is_one()) {
    share = refresh_share(scene);
  } else {
    for (const Share& each : cell.shares.all) {
      std::vector<ObjectPair> pairs;
      for (const std::uint32_t pair : each.pairs) pairs.push_back(scene.pairs[pair]);
      const RefreshShare of = refresh_share(scene, pairs);
      if (of.queries() > share.queries()) share = of;
    }
  }
  if (share.queries() <= scene.budget) return;
  diagnostics_.add(
      timing_.budget != nullptr ? *timing_.budget : root,
      fmt::format("found a budget of {}; expected at least {} queries a tick, which refreshing "
                  "every pair within refresh_s takes (ticks: {}): raise budget or refresh_s",
                  scene.budget, share.queries(), share.ticks));
}

}  // namespace

struct CellReadings::State {
  State(std::filesystem::path of, CellOptions how)
      : file(std::move(of)),
        options(std::move(how)),
        revision(options.root, options.may_read),
        meshes(file, revision, options.tell, options.is_of_urdf ? Advice::kUrdf : Advice::kCell,
               options.meshes_ahead) {}

  Cell read(const YamlNode& document, const std::string& yaml, Diagnostics& diagnostics) {
    Cell cell;
    revision = Revision(options.root, options.may_read);
    revision.add(without_partner(document, yaml));
    CellReader(file, options, meshes, shapes, diagnostics, revision).read(document, cell);
    return cell;
  }

  std::filesystem::path file;
  CellOptions options;
  Revision revision;
  MeshLibrary meshes;
  ConvexShapes shapes;
};

CellReadings::CellReadings(std::filesystem::path file, CellOptions options)
    : state_(std::make_unique<State>(std::move(file), std::move(options))) {}
CellReadings::~CellReadings() = default;
CellReadings::CellReadings(CellReadings&&) noexcept = default;
CellReadings& CellReadings::operator=(CellReadings&&) noexcept = default;

// The revision covers the text, but not the name of a partner, and, through the readers, the bytes
// of every file that it names. If a mesh has to be split, which takes seconds, the cell is read
// twice, so that its mistakes are reported first.
CellResult CellReadings::read(const YamlNode& document, const std::string& yaml) {
  State& s = *state_;
  Diagnostics diagnostics(s.file.string(),
                          s.options.is_of_urdf ? CellText::kOfUrdf : CellText::kWritten);
  s.meshes.begin_reading();
  Cell cell = s.read(document, yaml, diagnostics);
  const bool wants = s.options.meshes_ahead != nullptr && !s.options.meshes_ahead->wanted.empty();
  if (diagnostics.empty() && s.meshes.has_put_off() && !wants) {
    s.meshes.split_from_here();
    cell = s.read(document, yaml, diagnostics);
  }
  if (!diagnostics.empty()) return diagnostics.sorted();
  cell.scene.revision = s.revision.value();
  cell.yaml = yaml;
  cell.file = std::filesystem::absolute(s.file).lexically_normal();
  cell.files = s.revision.files();
  cell.file_hashes = s.revision.file_hashes();
  cell.hash = s.revision.hash();
  return cell;
}

CellResult parse_cell(const std::string& yaml, const std::filesystem::path& file,
                      const CellOptions& options) {
  const auto document = parse_yaml(yaml);
  if (const auto* fault = std::get_if<YamlFault>(&document)) {
    Diagnostics diagnostics(file.string(),
                            options.is_of_urdf ? CellText::kOfUrdf : CellText::kWritten);
    diagnostics.add(fault->line, fault->column, fault->reason);
    return diagnostics.sorted();
  }
  return CellReadings(file, options).read(std::get<YamlNode>(document), yaml);
}

CellResult read_cell(const std::filesystem::path& file, const CellOptions& options) {
  const auto bytes = read_bytes(file.string());
  if (const auto* fault = std::get_if<FileFault>(&bytes)) {
    Diagnostics diagnostics(file.string());
    diagnostics.add(1, 1,
                    fmt::format("found no cell file: {}; expected a YAML file", fault->reason));
    return diagnostics.sorted();
  }
  return parse_cell(std::get<std::string>(bytes), file, options);
}

}  // namespace clearance
