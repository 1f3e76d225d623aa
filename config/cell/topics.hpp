// DDS names of the topics; the defaults are those of idl/README.md.
#pragma once

#include <string>

namespace clearance {

struct Topics {
  std::string poses = "clearance/poses";
  std::string distances = "clearance/distances";
  std::string catalogue = "clearance/catalogue";
  std::string health = "clearance/health";
  std::string zones = "clearance/zones";
  std::string joint_states = "clearance/joint_states";
  std::string separation = "clearance/separation";
  std::string gradients = "clearance/gradients";
};

}  // namespace clearance
