#include "monitor/tick/constant_memory.hpp"

#include <fmt/format.h>

#include "core/body_tables.hpp"

namespace clearance {

// Values that are larger than a block are divided by bytes, and tables by values.
void ConstantMemory::add(const char* table, const void* at, std::size_t size, std::size_t stride,
                         std::size_t count) {
  const auto* first = static_cast<const std::byte*>(at);
  if (size == stride) {  // without gaps
    size *= count;
    stride = size;
    count = 1;
  }
  const auto owner = static_cast<std::uint32_t>(owners_.size() - 1);
  const auto number = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  while (count > 0) {
    ConstantBlock block{first, number(size), number(stride), number(count), owner, table};
    if (count == 1 && size > most_cost_) {
      block.size = block.stride = number(most_cost_);
      first += most_cost_;
      size -= most_cost_;
      stride = size;
    } else {
      while (block.count > 1 && block.cost() > most_cost_) block.count = (block.count + 1) / 2;
      first += block.count * stride;
      count -= block.count;
    }
    blocks_.push_back(block);
  }
}

void ConstantMemory::add(const ConvexBody& body) {
  each_table(body, [this](const char* table, const auto& all) { (*this)(table, all); });
}

void ConstantMemory::add(const Scene& scene) {
  begin("the scene");
  add_value("its figures", scene);
  add_inside("names", scene.name);
  (*this)("sensors", scene.sensors);
  (*this)("joint variables", scene.variables);
  (*this)("pairs", scene.pairs);
  (*this)("rules", scene.rules);
  (*this)("exceptions", scene.exceptions);
  (*this)("pairs that may touch", scene.may_touch);
  (*this)("attachments", scene.attachments);
  (*this)("zones", scene.zones);
  (*this)("contacts", scene.contacts);
  (*this)("robots", std::span<const Robot>(scene.robots));
  (*this)("objects", std::span<const Object>(scene.objects));
  for (const Robot& robot : scene.robots) {
    begin(fmt::format("the robot '{}'", robot.name));
    add_inside("names", robot);
  }
  for (const Object& object : scene.objects) {
    begin(fmt::format("the object '{}'", object.name));
    add_inside("names", object);
  }
}

// A short text is a part of its owner.
void ConstantMemory::add_inside(const char* table, const std::string& text) {
  const auto* const owner = reinterpret_cast<const char*>(&text);
  if (text.data() >= owner && text.data() < owner + sizeof text) return;
  add(table, text.data(), text.size() + 1, text.size() + 1, 1);
}

void ConstantMemory::add_inside(const char* table, const Object& object) {
  for (const std::string* text : {&object.name, &object.source, &object.frame})
    add_inside(table, *text);
  (*this)("names of groups", object.groups);
  (*this)("parts", std::span<const Part>(object.parts));
  for (const Part& part : object.parts) {
    add_inside(table, part.name);
    add(part.shape);
  }
}

void ConstantMemory::add_inside(const char* table, const Sensor& sensor) {
  for (const std::string* text :
       {&sensor.name, &sensor.topic, &sensor.camera_info, &sensor.mount.frame})
    add_inside(table, *text);
  (*this)("balls of sensors", sensor.crop);
}

void ConstantMemory::add_inside(const char* table, const Robot& robot) {
  for (const std::string* text :
       {&robot.name, &robot.prefix, &robot.joint_states, &robot.base.frame})
    add_inside(table, *text);
  (*this)("links", robot.links);
  (*this)("joints", robot.joints);
  (*this)("notes", robot.notes);
  const RobotStops& stops = robot.stopping;
  add_inside("stops", stops.stated_on);
  (*this)("stops", stops.joints);
  (*this)("steps of stops", stops.steps);
  (*this)("steps of loads", stops.load.steps);
  (*this)("levers of the extension", stops.extension.levers);
  (*this)("accelerations", stops.max_accelerations);
}

void ConstantMemory::add_inside(const char* table, const RobotLink& link) {
  add_inside(table, link.name);
}

void ConstantMemory::add_inside(const char* table, const RobotJoint& joint) {
  add_inside(table, joint.name);
}

void ConstantMemory::add_inside(const char* table, const JointVariable& variable) {
  add_inside(table, variable.name);
  add_inside(table, variable.source);
}

void ConstantMemory::add_inside(const char* table, const JointStop& stop) {
  (*this)(table, stop.points());
}

void ConstantMemory::add_inside(const char* table, const StopStep& step) {
  (*this)(table, step.joints);
}

void ConstantMemory::add_inside(const char* table, const NamedPair& rule) {
  add_inside(table, rule.a);
  add_inside(table, rule.b);
}

void ConstantMemory::add_inside(const char* table, const Zone& zone) {
  for (const std::string* text : {&zone.name, &zone.group_a, &zone.group_b})
    add_inside(table, *text);
  (*this)("pairs of zones", zone.pairs);
  if (zone.separation) (*this)("human sides of zones", zone.separation->human_is_first);
}

void ConstantMemory::add_inside(const char* table, const AllowedContact& contact) {
  for (const std::string* text :
       {&contact.name, &contact.group_a, &contact.group_b, &contact.by, &contact.reason})
    add_inside(table, *text);
  (*this)("pairs of contacts", contact.pairs);
}

}  // namespace clearance
