#include "collision_check.hpp"

#include "moveit_log.hpp"

#include <algorithm>
#include <utility>

namespace clearance_moveit {
namespace {

using Decision = PairFilter::Decision;

std::pair<std::string, std::string> sorted(const std::string& a, const std::string& b) {
  return a < b ? std::pair(a, b) : std::pair(b, a);
}

}  // namespace

collision_detection::Contact contact_of(const Found& found, const Owner& a, const Owner& b) {
  collision_detection::Contact contact;
  contact.pos = 0.5 * (found.point_a + found.point_b);
  contact.normal = found.normal;
  contact.depth = std::max(0.0, -found.distance);
  contact.body_name_1 = a.name;
  contact.body_type_1 = a.type;
  contact.body_name_2 = b.name;
  contact.body_type_2 = b.type;
  contact.nearest_points[0] = found.point_a;
  contact.nearest_points[1] = found.point_b;
  return contact;
}

void CollisionCheck::check(const PosedParts& a, const PosedParts& b, PairFilter& filter) {
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    for (std::size_t j = &a == &b ? i + 1 : 0; j < b.parts.size(); ++j) {
      if (!overlap(a.boxes[i], b.boxes[j])) continue;
      check_parts(a, i, b, j, filter);
      if (done_) return;
    }
  }
}

// How many more contacts of the pair the request asks for.
std::size_t CollisionCheck::wanted(const Owner& a, const Owner& b) const {
  if (!request_.contacts || result_.contact_count >= request_.max_contacts) return 0;
  const auto of_pair = result_.contacts.find(sorted(a.name, b.name));
  const std::size_t have = of_pair == result_.contacts.end() ? 0 : of_pair->second.size();
  if (have >= request_.max_contacts_per_pair) return 0;
  return std::min(request_.max_contacts_per_pair - have,
                  request_.max_contacts - result_.contact_count);
}

void CollisionCheck::keep(const collision_detection::Contact& contact) {
  result_.contacts[sorted(contact.body_name_1, contact.body_name_2)].push_back(contact);
  ++result_.contact_count;
}

void CollisionCheck::check_parts(const PosedParts& a, std::size_t i, const PosedParts& b,
                                 std::size_t j, PairFilter& filter) {
  const PosedPart &part_a = a.parts[i], &part_b = b.parts[j];
  if (&a == &b && part_a.owner == part_b.owner) return;
  const Decision decision = filter.decide(part_a.owner, part_b.owner);
  if (decision == Decision::kLeftOut) return;
  const Owner &owner_a = a.owners[part_a.owner], &owner_b = b.owners[part_b.owner];
  std::size_t left = wanted(owner_a, owner_b);
  collision_detection::DecideContactFn is_allowed;
  if (decision == Decision::kConditional) is_allowed = filter.decider(part_a.owner, part_b.owner);
  const Depth depth = left > 0 || is_allowed ? Depth::kAsked : Depth::kNotAsked;
  query_parts(part_a, a.boxes[i], part_b, b.boxes[j], 0.0, depth, [&](const Found& found) {
    if (!found.collides) return true;
    collision_detection::Contact contact;
    if (depth == Depth::kAsked) contact = contact_of(found, owner_a, owner_b);
    if (is_allowed && is_allowed(contact)) return true;
    result_.collision = true;
    if (request_.verbose) {
      RCLCPP_INFO(logger(), "Contact between '%s' and '%s'", owner_a.name.c_str(),
                  owner_b.name.c_str());
    }
    if (left > 0) {
      keep(contact);
      --left;
    }
    return left > 0;
  });
  conclude();
}

void CollisionCheck::conclude() {
  if (result_.collision && (!request_.contacts || result_.contact_count >= request_.max_contacts))
    done_ = true;
  if (!done_ && request_.is_done) done_ = request_.is_done(result_);
}

}  // namespace clearance_moveit
