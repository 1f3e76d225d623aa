// The types of the topics, without the client library.
#include <clearance.h>

#include <string>

int main() {
  const std::string name = clearance_msg_Distances_desc.m_typename;
  return name == "clearance::msg::Distances" ? 0 : 1;
}
