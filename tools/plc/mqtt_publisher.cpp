#include "tools/plc/mqtt_publisher.hpp"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <stdexcept>
#include <variant>

#include "config/text/file_bytes.hpp"
#include "monitor/app/log_line.hpp"
#include "monitor/interface/mutex.hpp"
#include "monitor/interface/plc_log_lines.hpp"

namespace clearance::plc {
namespace {

constexpr std::int64_t kRepeatNs = 1'000'000'000;
constexpr int kKeepAlive_s = 5;  // the least that brokers take: a broken link is noticed in 8 s
constexpr const char* kFailSafe = "fail-safe";

std::string escaped(const std::string& name) {
  std::string text;
  for (const char c : name) {
    if (std::string_view("/+#%$").find(c) == std::string_view::npos)
      text += c;
    else
      text += fmt::format("%{:02X}", static_cast<unsigned>(c));
  }
  return text;
}

// Returns the bytes of a file that a key names, without the end of its line.
std::string content(const std::filesystem::path& file, const char* key) {
  auto bytes = read_bytes(file.string());
  if (const auto* fault = std::get_if<FileFault>(&bytes))
    throw std::runtime_error(fmt::format("plc: mqtt: {}: {}", key, fault->reason));
  std::string text = std::get<std::string>(std::move(bytes));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text;
}

void require(int result, const char* attempted) {
  if (result != MOSQ_ERR_SUCCESS)
    throw std::runtime_error(
        fmt::format("plc: mqtt: {} failed: {}", attempted, mosquitto_strerror(result)));
}

void use_tls(mosquitto* client, const MqttSettings& mqtt) {
  if (mqtt.ca_file.empty()) return;
  content(mqtt.ca_file, "ca_file");
  const bool has_own = !mqtt.certificate_file.empty();
  if (has_own) {
    content(mqtt.certificate_file, "certificate_file");
    content(mqtt.key_file, "key_file");
  }
  require(mosquitto_tls_set(client, mqtt.ca_file.c_str(), nullptr,
                            has_own ? mqtt.certificate_file.c_str() : nullptr,
                            has_own ? mqtt.key_file.c_str() : nullptr, nullptr),
          "to use TLS");
}

// What people and programs read: "clear", or a number in the row's unit.
std::string text_of(const PlcRow& row, const Encoded& encoded) {
  if (row.value == PlcValue::kClear) return encoded.count == 1.0 ? "clear" : "active";
  return fmt::format("{:.9g}", row.has_unit() ? encoded.count * row.scale : encoded.count);
}

}  // namespace

std::string topic_of(const PlcSettings& settings, const PlcRow& row) {
  std::string topic = settings.mqtt.topic;
  if (!row.zone.empty()) topic += "/zone/" + escaped(row.zone);
  if (!row.robot.empty()) topic += "/robot/" + escaped(row.robot);
  return topic + "/" + std::string(row.key().key);
}

MqttPublisher::MqttPublisher(const PlcSettings& settings)
    : settings_(settings),
      client_(nullptr, mosquitto_destroy),
      state_topic_(settings.mqtt.topic + "/state"),
      texts_(settings.rows.size()) {
  for (const PlcRow& row : settings.rows) topics_.push_back(topic_of(settings, row));
  const MqttSettings& mqtt = settings.mqtt;
  mosquitto_lib_init();
  client_.reset(mosquitto_new(nullptr, true, this));
  if (!client_) throw std::runtime_error("plc: mqtt: mosquitto's library has no memory");
  mosquitto* const client = client_.get();
  if (!mqtt.user.empty()) {
    const std::string password =
        mqtt.password_file.empty() ? "" : content(mqtt.password_file, "password_file");
    require(mosquitto_username_pw_set(client, mqtt.user.c_str(),
                                      mqtt.password_file.empty() ? nullptr : password.c_str()),
            "to set the password");
  }
  use_tls(client, mqtt);
  require(
      mosquitto_will_set(client, state_topic_.c_str(),
                         static_cast<int>(std::string_view(kFailSafe).size()), kFailSafe, 1, true),
      "to set the last will");
  mosquitto_connect_callback_set(client, [](mosquitto*, void* self, int result) {
    static_cast<MqttPublisher*>(self)->on_connect(result);
  });
  mosquitto_threaded_set(client, true);
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

// A program that ends in order has no last will, so it says the same.
MqttPublisher::~MqttPublisher() {
  if (is_connected_) say_fail_safe();
  mosquitto_disconnect(client_.get());
  thread_ = {};  // asks it to stop, and waits
  client_.reset();
  mosquitto_lib_cleanup();
}

// mosquitto_loop_start() gives up after a fault of TLS or of a name, which may pass. At the end,
// what is queued still leaves, if the broker takes it at once.
void MqttPublisher::run(const std::stop_token& stop) {
  constexpr int kWait_ms = 10, kLastLoops = 50;
  constexpr std::chrono::milliseconds kRetry(1000);
  Mutex mutex;
  std::condition_variable_any waits;
  int result = mosquitto_connect_async(client_.get(), settings_.mqtt.host.c_str(),
                                       settings_.mqtt.port, kKeepAlive_s);
  for (int last = 0; last < kLastLoops;) {
    while (result == MOSQ_ERR_SUCCESS && last < kLastLoops) {
      result = mosquitto_loop(client_.get(), kWait_ms, 1);
      if (stop.stop_requested()) ++last;
    }
    is_connected_ = false;
    if (stop.stop_requested()) return;
    tell(mosquitto_strerror(result), true);
    Lock lock(mutex);
    if (waits.wait_for(lock, stop, kRetry, [] { return false; }) || stop.stop_requested()) return;
    result = mosquitto_reconnect_async(client_.get());
  }
}

// The reason that a broker gives is better than that of the end of the connection behind it.
void MqttPublisher::tell(const std::string& state, bool is_first_reason) {
  const Lock lock(mutex_);
  if (told_ == state || (is_first_reason && told_ && !told_->empty())) return;
  told_ = state;
  const std::string broker = fmt::format("{}:{}", settings_.mqtt.host, settings_.mqtt.port);
  if (state.empty())
    log_line(lines::kMqttConnected, broker);
  else
    log_line(lines::kMqttAway, broker, state);
}

void MqttPublisher::on_connect(int result) {
  if (result != 0) return tell(mosquitto_connack_string(result));
  say_fail_safe();
  is_new_ = true;
  is_connected_ = true;
  tell("");
}

void MqttPublisher::say_fail_safe() { send(state_topic_, kFailSafe, true); }

// Nothing waits for a broker that is away: what it would get later would be old.
void MqttPublisher::send(const std::string& topic, const std::string& text, bool retained) {
  mosquitto_publish(client_.get(), nullptr, topic.c_str(), static_cast<int>(text.size()),
                    text.c_str(), 0, retained);
}

void MqttPublisher::publish(const HeldFigures& figures, const RegisterTable& table,
                            std::int64_t now_ns) {
  if (!is_connected_) return;
  const bool is_all = is_new_.exchange(false) || now_ns >= repeat_ns_;
  if (is_all) repeat_ns_ = now_ns + kRepeatNs;
  const std::string state = figures.cause() == Cause::kNone ? "good" : kFailSafe;
  // 'fail-safe' comes before the figures, and 'good' behind them.
  const auto send_state = [&](bool is_good) {
    if (is_good == (state == "good") && (is_all || state != state_))
      is_good ? send(state_topic_, state) : say_fail_safe();
  };
  send_state(false);
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    std::string text = text_of(settings_.rows[i], table.rows()[i]);
    if (is_all || text != texts_[i]) send(topics_[i], text);
    texts_[i] = std::move(text);
  }
  send_state(true);
  state_ = state;
}

}  // namespace clearance::plc
