// The DDS names of the topics; the defaults are those of idl/README.md.
#pragma once

#include <array>
#include <string>
#include <string_view>

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
  std::string commands = "clearance/commands";
  std::string command_results = "clearance/command_results";
  std::string questions = "clearance/questions";
  std::string answers = "clearance/answers";
  std::string partner_ticks = "clearance/partner_ticks";
  std::string partner_states = "clearance/partner_states";
  std::string partner_frames = "clearance/partner_frames";
  std::string partner_scenes = "clearance/partner_scenes";
};

// A topic by its key in a cell and in command lines.
struct TopicKey {
  std::string_view key;
  std::string Topics::*name;
};
inline constexpr std::array<TopicKey, 16> kTopicKeys = {{
    {"catalogue", &Topics::catalogue},
    {"poses", &Topics::poses},
    {"joint_states", &Topics::joint_states},
    {"distances", &Topics::distances},
    {"zones", &Topics::zones},
    {"health", &Topics::health},
    {"separation", &Topics::separation},
    {"gradients", &Topics::gradients},
    {"commands", &Topics::commands},
    {"command_results", &Topics::command_results},
    {"questions", &Topics::questions},
    {"answers", &Topics::answers},
    {"partner_ticks", &Topics::partner_ticks},
    {"partner_states", &Topics::partner_states},
    {"partner_frames", &Topics::partner_frames},
    {"partner_scenes", &Topics::partner_scenes},
}};

}  // namespace clearance
