// Publishes figures to an MQTT broker, by mosquitto's library in a thread of its own: a broker that
// is slow or away delays nothing here.
//
// Only 'fail-safe' is retained, and it is the last will, too. So a client that subscribes hears it
// first, and anything else only while this program and the broker live.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <mosquitto.h>

#include "config/cell/plc_settings.hpp"
#include "monitor/interface/mutex.hpp"
#include "tools/plc/held_figures.hpp"
#include "tools/plc/register_table.hpp"

namespace clearance::plc {

class MqttPublisher {
 public:
  // Throws std::runtime_error if a file that the settings name cannot be read.
  explicit MqttPublisher(const PlcSettings& settings);
  // Says 'fail-safe', and leaves.
  ~MqttPublisher();
  MqttPublisher(const MqttPublisher&) = delete;
  MqttPublisher& operator=(const MqttPublisher&) = delete;

  // Publishes what has changed, and everything once per second. `now_ns` as in HeldFigures.
  void publish(const HeldFigures& figures, const RegisterTable& table, std::int64_t now_ns);

 private:
  void run(const std::stop_token& stop);
  void on_connect(int result);
  void tell(const std::string& state, bool is_first_reason = false);
  void say_fail_safe();
  void send(const std::string& topic, const std::string& text, bool retained = false);

  const PlcSettings& settings_;
  std::unique_ptr<mosquitto, void (*)(mosquitto*)> client_;
  std::string state_topic_;
  std::vector<std::string> topics_, texts_;  // by row
  std::string state_;
  std::int64_t repeat_ns_ = 0;  // when everything is sent again
  std::atomic<bool> is_connected_ = false, is_new_ = false;
  Mutex mutex_;
  // The reason why the broker is away, as logged last; empty: it is not. Both threads write it.
  GUARDED_BY(mutex_) std::optional<std::string> told_;
  std::jthread thread_;  // of run(); it uses all of the above
};

// "clearance/zone/people/clear". Characters of names that topics reserve are written as %2F.
[[nodiscard]] std::string topic_of(const PlcSettings& settings, const PlcRow& row);

}  // namespace clearance::plc
