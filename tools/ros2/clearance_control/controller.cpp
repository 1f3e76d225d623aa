#include "controller.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <pluginlib/class_list_macros.hpp>
#include <stdexcept>
#include <utility>

namespace clearance_control {
namespace {

using controller_interface::CallbackReturn;
using controller_interface::return_type;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// One value counts for all joints.
std::vector<double> one_for_each(const std::string& name, std::vector<double> values,
                                 std::size_t joints) {
  if (values.size() == 1) values.resize(joints, values.front());
  const bool are_positive =
      std::ranges::all_of(values, [](double each) { return each > 0.0 && std::isfinite(each); });
  if (values.size() != joints || !are_positive)
    throw std::invalid_argument(name + " has to have a value above 0, or one for each joint");
  return values;
}

}  // namespace

// The first entry before that time was in force then.
double SpeedHistory::least_since(std::int64_t since_ns) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t back = 1; back <= std::min(count_, entries_.size()); ++back) {
    const Entry& entry = entries_[(count_ - back) % entries_.size()];
    least = std::min(least, entry.speed);
    if (entry.at_ns <= since_ns) return least;
  }
  return 0.0;
}

CallbackReturn ClearanceLimiter::on_init() {
  auto_declare<std::vector<std::string>>("joints", {});
  auto_declare<std::string>("interface", "");
  auto_declare<std::vector<double>>("max_velocity", {});
  auto_declare<std::vector<double>>("deceleration", {});
  auto_declare<double>("stop_at", kNaN);
  auto_declare<double>("slow_from", kNaN);
  auto_declare<std::vector<std::string>>("pairs", {});
  auto_declare<std::vector<std::string>>("zones", {});
  auto_declare<bool>("obey_scaling", false);
  auto_declare<double>("reports_count_for", 0.0);
  auto_declare<int>("domain", -1);
  auto_declare<std::string>("partition", "");
  auto_declare<std::string>("network", "");
  return CallbackReturn::SUCCESS;
}

void ClearanceLimiter::read_parameters() {
  const auto get = [this](const char* name) { return get_node()->get_parameter(name); };
  joints_ = get("joints").as_string_array();
  interface_ = get("interface").as_string();
  if (joints_.empty()) throw std::invalid_argument("joints are missing");
  if (interface_ != "position" && interface_ != "velocity")
    throw std::invalid_argument("interface has to be position or velocity");
  const auto velocities =
      one_for_each("max_velocity", get("max_velocity").as_double_array(), joints_.size());
  const auto decelerations =
      one_for_each("deceleration", get("deceleration").as_double_array(), joints_.size());
  std::vector<JointLimits> limits;
  for (std::size_t i = 0; i < joints_.size(); ++i)
    limits.push_back({.max_velocity = velocities[i], .deceleration = decelerations[i]});
  limiter_.emplace(interface_ == "position" ? Limiter::Kind::kPosition : Limiter::Kind::kVelocity,
                   std::move(limits));

  PermitOptions options{.stop_at = get("stop_at").as_double(),
                        .slow_from = get("slow_from").as_double(),
                        .pairs = get("pairs").as_string_array(),
                        .zones = get("zones").as_string_array(),
                        .obeys_scaling = get("obey_scaling").as_bool(),
                        .joints = joints_};
  const double count_for_s = get("reports_count_for").as_double();
  if (!(count_for_s >= 0.0 && count_for_s <= 1.0))
    throw std::invalid_argument("reports_count_for has to be a time from 0 to 1 s");
  options.stream.period = std::chrono::nanoseconds(std::llround(1e9 * count_for_s));
  clearance::DdsOptions dds{.partition = get("partition").as_string(),
                            .interface = get("network").as_string()};
  if (const auto domain = get("domain").as_int(); domain >= 0)
    dds.domain = static_cast<std::uint32_t>(domain);
  permits_ = std::make_shared<PermitReader>(
      dds, std::move(options), [logger = get_node()->get_logger()](const std::string& cause) {
        RCLCPP_INFO(logger, "what limits: %s", cause.c_str());
      });
  RCLCPP_INFO(get_node()->get_logger(), "reads reports of %s", permits_->where().c_str());
}

CallbackReturn ClearanceLimiter::on_configure(const rclcpp_lifecycle::State&) {
  try {
    read_parameters();
  } catch (const std::exception& error) {
    RCLCPP_ERROR(get_node()->get_logger(), "%s", error.what());
    return CallbackReturn::FAILURE;
  }
  references_.assign(joints_.size(), kNaN);
  commands_.assign(joints_.size(), 0.0);
  acknowledge_ = get_node()->create_service<std_srvs::srv::Trigger>(
      "~/acknowledge",
      [permits = permits_](const std_srvs::srv::Trigger::Request::SharedPtr&,
                           const std_srvs::srv::Trigger::Response::SharedPtr& response) {
        permits->acknowledge();
        response->success = true;
      });
  return CallbackReturn::SUCCESS;
}

CallbackReturn ClearanceLimiter::on_cleanup(const rclcpp_lifecycle::State&) {
  acknowledge_.reset();
  permits_.reset();
  return CallbackReturn::SUCCESS;
}

std::vector<std::string> ClearanceLimiter::interface_names(const std::string& interface) const {
  std::vector<std::string> names;
  for (const std::string& joint : joints_) names.push_back(joint + "/" + interface);
  return names;
}

controller_interface::InterfaceConfiguration ClearanceLimiter::command_interface_configuration()
    const {
  return {controller_interface::interface_configuration_type::INDIVIDUAL,
          interface_names(interface_)};
}

// The same interface, for the place or the velocity at which the first update begins.
controller_interface::InterfaceConfiguration ClearanceLimiter::state_interface_configuration()
    const {
  return {controller_interface::interface_configuration_type::INDIVIDUAL,
          interface_names(interface_)};
}

std::vector<hardware_interface::CommandInterface::SharedPtr>
ClearanceLimiter::on_export_reference_interfaces_list() {
  std::vector<hardware_interface::CommandInterface::SharedPtr> exported;
  for (const std::string& name : interface_names(interface_))
    exported.push_back(
        std::make_shared<hardware_interface::CommandInterface>(get_node()->get_name(), name));
  return exported;
}

std::vector<hardware_interface::StateInterface::SharedPtr>
ClearanceLimiter::on_export_state_interfaces_list() {
  std::vector<hardware_interface::StateInterface::SharedPtr> exported;
  for (const char* name : {"scaling", "cause"})
    exported.push_back(
        std::make_shared<hardware_interface::StateInterface>(get_node()->get_name(), name));
  return exported;
}

void ClearanceLimiter::forget_references() {
  for (const auto& reference : ordered_exported_reference_interfaces_)
    static_cast<void>(reference->set_value(kNaN));
  std::ranges::fill(references_, kNaN);
}

// References of another controller are no longer meant.
bool ClearanceLimiter::on_set_chained_mode(bool) {
  forget_references();
  return true;
}

CallbackReturn ClearanceLimiter::on_activate(const rclcpp_lifecycle::State&) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const std::optional<double> value = state_interfaces_[i].get_optional();
    if (!value || !std::isfinite(*value)) {
      RCLCPP_ERROR(get_node()->get_logger(), "the %s of %s is not known", interface_.c_str(),
                   joints_[i].c_str());
      return CallbackReturn::FAILURE;
    }
    commands_[i] = *value;
  }
  limiter_->start(commands_);
  speeds_.forget();
  return CallbackReturn::SUCCESS;
}

// A velocity that is commanded would go on.
CallbackReturn ClearanceLimiter::on_deactivate(const rclcpp_lifecycle::State&) {
  if (interface_ == "velocity") {
    for (auto& command : command_interfaces_) static_cast<void>(command.set_value(0.0));
  }
  forget_references();
  return CallbackReturn::SUCCESS;
}

Permitted ClearanceLimiter::permitted(std::int64_t now_ns, Cause& cause) noexcept {
  const Permit& permit = permits_->newest();
  cause = permit.cause_at(now_ns);
  if (permit.error(now_ns) != clearance::ReportError::kGood) return {.scaling = 0.0};
  Permitted found{.scaling = permit.scaling};
  if (permit.of_present < 1.0)
    found.most_speed = permit.of_present * speeds_.least_since(permit.since_ns);
  return found;
}

// Without a controller before it, nothing writes references, and commands are held.
return_type ClearanceLimiter::update_reference_from_subscribers(const rclcpp::Time&,
                                                                const rclcpp::Duration&) {
  return return_type::OK;
}

// A value that another thread holds in this moment stays as it was until the next update.
return_type ClearanceLimiter::update_and_write_commands(const rclcpp::Time&,
                                                        const rclcpp::Duration& period) {
  for (std::size_t i = 0; i < references_.size(); ++i) {
    if (const auto value = ordered_exported_reference_interfaces_[i]->get_optional())
      references_[i] = *value;
  }
  const std::int64_t now_ns = clearance::client::monotonic_ns();
  Cause cause = Cause::kNone;
  const Permitted allowed = permitted(now_ns, cause);
  limiter_->update(references_, allowed, period.seconds(), commands_);
  if (cause == Cause::kNone && limiter_->is_away()) cause = Cause::kAway;
  speeds_.add(now_ns, limiter_->speed());
  for (std::size_t i = 0; i < commands_.size(); ++i)
    static_cast<void>(command_interfaces_[i].set_value(commands_[i]));
  static_cast<void>(ordered_exported_state_interfaces_[0]->set_value(
      std::min(allowed.scaling, allowed.most_speed)));
  static_cast<void>(ordered_exported_state_interfaces_[1]->set_value(static_cast<double>(cause)));
  return return_type::OK;
}

}  // namespace clearance_control

PLUGINLIB_EXPORT_CLASS(clearance_control::ClearanceLimiter,
                       controller_interface::ChainableControllerInterface)
