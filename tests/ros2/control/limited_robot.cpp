#include "limited_robot.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <limits>
#include <mutex>
#include <std_srvs/srv/trigger.hpp>
#include <stdexcept>
#include <vector>

#include "counted_allocations.hpp"

extern char** environ;

namespace clearance_control_test {
namespace {

using controller_interface::CallbackReturn;
using controller_interface::InterfaceConfiguration;
using controller_interface::return_type;
constexpr auto kIndividual = controller_interface::interface_configuration_type::INDIVIDUAL;
const std::array<std::string, 2> kJoints = {"slide", "lift"};

// The hand's front is at 0.1 + slide, and the wall at 1.1.
constexpr const char* kLinks = R"(
  <link name="rail"/>
  <link name="carriage"/>
  <link name="hand"><collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision></link>
  <joint name="slide" type="prismatic"><parent link="rail"/><child link="carriage"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" velocity="9" effort="99"/></joint>
  <joint name="lift" type="prismatic"><parent link="carriage"/><child link="hand"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" velocity="9" effort="99"/></joint>
)";

std::string control_xml(const RobotOptions& options) {
  std::string joints;
  for (const std::string& joint : kJoints) {
    const double begin = joint == "slide" ? options.slide : 0.0;
    joints += "<joint name=\"" + joint + "\"><command_interface name=\"" + options.interface +
              "\"/><state_interface name=\"position\"><param name=\"initial_value\">" +
              std::to_string(begin) +
              "</param></state_interface><state_interface name=\"velocity\"/></joint>";
  }
  return R"(<ros2_control name="mock" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>
    <param name="calculate_dynamics">true</param></hardware>)" +
         joints + "</ros2_control>";
}

void write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path) << text;
}

// Writes the references of a test to the limiter.
class Commander : public controller_interface::ControllerInterface {
 public:
  Commander(std::string interface, const Values& references)
      : interface_(std::move(interface)), references_(references) {}
  CallbackReturn on_init() override { return CallbackReturn::SUCCESS; }
  InterfaceConfiguration command_interface_configuration() const override {
    InterfaceConfiguration names{kIndividual, {}};
    for (const std::string& joint : kJoints)
      names.names.push_back("limiter/" + joint + "/" + interface_);
    return names;
  }
  InterfaceConfiguration state_interface_configuration() const override { return {}; }
  return_type update(const rclcpp::Time&, const rclcpp::Duration&) override {
    for (std::size_t i = 0; i < 2; ++i)
      static_cast<void>(command_interfaces_[i].set_value(references_[i]));
    return return_type::OK;
  }

 private:
  std::string interface_;
  const Values& references_;
};

// Reads what the hardware and the limiter say.
class Observer : public controller_interface::ControllerInterface {
 public:
  explicit Observer(Observed& observed) : observed_(observed) {}
  CallbackReturn on_init() override { return CallbackReturn::SUCCESS; }
  InterfaceConfiguration command_interface_configuration() const override { return {}; }
  InterfaceConfiguration state_interface_configuration() const override {
    return {kIndividual,
            {"slide/position", "lift/position", "slide/velocity", "lift/velocity",
             "limiter/scaling", "limiter/cause"}};
  }
  return_type update(const rclcpp::Time&, const rclcpp::Duration&) override {
    const auto value = [this](std::size_t i) {
      return state_interfaces_[i].get_optional().value();
    };
    observed_ = {.positions = {value(0), value(1)},
                 .velocities = {value(2), value(3)},
                 .scaling = value(4),
                 .cause = static_cast<int>(value(5))};
    return return_type::OK;
  }

 private:
  Observed& observed_;
};

}  // namespace

Daemon::Daemon(const std::filesystem::path& folder, const std::string& stopping) {
  write(folder / "slider.urdf", "<robot name=\"slider\">" + std::string(kLinks) + "</robot>");
  write(folder / "cell.yaml",
        "name: slider\nunits: {length: m, angle: rad}\nrate_hz: 1000\n"
        "defaults: {age_limit_ms: 100}\n"
        "objects:\n"
        "  - {name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -1.1}}\n"
        "robots:\n"
        "  - {name: arm, urdf: slider.urdf, joint_states: /joint_states" +
            (stopping.empty() ? "" : ", stopping: " + stopping) +
            "}\n"
            "pairs:\n  - {between: [arm, wall], publish: true}\n" +
            (stopping.empty() ? ""
                              : "zones:\n  - {name: stands, between: [arm, wall], "
                                "stops: {margin: 0.05}}\n"));
  std::string program = CLEARANCED, cell = folder / "cell.yaml";
  char* const arguments[] = {program.data(), cell.data(), nullptr};
  if (posix_spawn(&pid_, CLEARANCED, nullptr, nullptr, arguments, environ) != 0)
    throw std::runtime_error("clearanced does not start");
}

void Daemon::signal(int number) const { ::kill(pid_, number); }

std::chrono::steady_clock::time_point Daemon::kill() const {
  signal(SIGKILL);
  return std::chrono::steady_clock::now();
}

Daemon::~Daemon() {
  kill();
  waitpid(pid_, nullptr, 0);
}

LimitedRobot::LimitedRobot(const RobotOptions& options) : stopping(options.stopping) {
  std::string name = std::filesystem::temp_directory_path() / "clearance-control-XXXXXX";
  folder = mkdtemp(name.data());
  write_files(options);
  daemon = std::make_unique<Daemon>(folder, stopping);
  executor_ = std::make_shared<rclcpp::executors::MultiThreadedExecutor>();
  auto node_options = controller_manager::get_cm_node_options();
  node_options.parameter_overrides(
      {{"update_rate", 1000},
       {"use_sim_time", true},
       {"limiter.type", "clearance_control/ClearanceLimiter"},
       {"limiter.params_file", std::vector<std::string>{folder / "limiter.yaml"}}});
  const std::string urdf =
      "<robot name=\"slider\">" + std::string(kLinks) + control_xml(options) + "</robot>";
  manager_ = std::make_shared<controller_manager::ControllerManager>(
      executor_, urdf, true, "controller_manager", "", node_options);
  node_ = std::make_shared<rclcpp::Node>("slider_states");
  states_ = node_->create_publisher<sensor_msgs::msg::JointState>("joint_states", 10);
  executor_->add_node(manager_);
  spinning_ = std::thread([this] { executor_->spin(); });
  next_ = std::chrono::steady_clock::now();
  advance();

  limiter_ = manager_->load_controller("limiter");
  if (limiter_ == nullptr) throw std::runtime_error("the plug-in cannot be loaded");
  manager_->add_controller(std::make_shared<Commander>(options.interface, references_), "commander",
                           "Commander");
  manager_->add_controller(std::make_shared<Observer>(observed_), "observer", "Observer");
  for (const char* each : {"limiter", "commander", "observer"}) {
    if (manager_->configure_controller(each) != return_type::OK)
      throw std::runtime_error(std::string(each) + " cannot be configured");
  }
  observed_.positions[0] = options.slide;
  references_ = {options.interface == "position" ? options.slide : 0.0, 0.0};
  activate({"limiter", "commander", "observer"});
}

void LimitedRobot::write_files(const RobotOptions& options) const {
  write(folder / "limiter.yaml",
        "limiter:\n  ros__parameters:\n    joints: [slide, lift]\n    interface: " +
            options.interface +
            "\n    max_velocity: [0.5]\n    deceleration: [2.0]\n    reports_count_for: " +
            options.reports_count_for + "\n    " + options.limits + "\n");
}

// The switch is made by the loop.
void LimitedRobot::activate(const std::vector<std::string>& names) {
  auto done = std::async(std::launch::async, [&] {
    return manager_->switch_controller(
        names, {}, controller_manager_msgs::srv::SwitchController::Request::STRICT);
  });
  while (done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) step(references_);
  if (done.get() != return_type::OK) throw std::runtime_error("the controllers are not activated");
}

LimitedRobot::~LimitedRobot() {
  executor_->cancel();
  spinning_.join();
  std::filesystem::remove_all(folder);
}

// The robot's time goes on by a period in each cycle, so a late cycle only makes it slower.
void LimitedRobot::advance() {
  now_ += rclcpp::Duration::from_seconds(kPeriod);
  const rclcpp::Clock::SharedPtr clock = manager_->get_trigger_clock();
  const std::lock_guard lock(clock->get_clock_mutex());
  if (rcl_set_ros_time_override(clock->get_clock_handle(), now_.nanoseconds()) != RCL_RET_OK)
    throw std::runtime_error("the robot's time cannot be set");
}

void LimitedRobot::step(const Values& references) {
  references_ = references;
  const rclcpp::Duration period = rclcpp::Duration::from_seconds(kPeriod);
  advance();
  manager_->read(now_, period);
  manager_->update(now_, period);
  manager_->write(now_, period);
  sensor_msgs::msg::JointState message;
  message.header.stamp = node_->now();
  message.name.assign(kJoints.begin(), kJoints.end());
  message.position.assign(observed_.positions.begin(), observed_.positions.end());
  message.velocity.assign(observed_.velocities.begin(), observed_.velocities.end());
  states_->publish(message);
  next_ = std::max(next_ + std::chrono::milliseconds(1), std::chrono::steady_clock::now());
  std::this_thread::sleep_until(next_);
}

bool LimitedRobot::step_until(const std::function<Values()>& references,
                              const std::function<bool()>& is_so, double most_s) {
  for (double t_s = 0.0; t_s < most_s; t_s += kPeriod) {
    step(references());
    if (is_so()) return true;
  }
  return false;
}

std::uint64_t LimitedRobot::allocations_of_update() {
  const rclcpp::Duration period = rclcpp::Duration::from_seconds(kPeriod);
  const std::uint64_t before = counted_allocations();
  limiter_->update(now_, period);
  return counted_allocations() - before;
}

bool LimitedRobot::acknowledge() {
  const auto client = node_->create_client<std_srvs::srv::Trigger>("/limiter/acknowledge");
  if (!client->wait_for_service(std::chrono::seconds(20))) return false;
  auto answer = client->async_send_request(std::make_shared<std_srvs::srv::Trigger::Request>());
  return rclcpp::spin_until_future_complete(node_, answer, std::chrono::seconds(20)) ==
             rclcpp::FutureReturnCode::SUCCESS &&
         answer.get()->success;
}

}  // namespace clearance_control_test
