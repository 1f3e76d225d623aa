// A chainable controller of ros2_control between any controller of positions or velocities and the
// hardware: commands pass, are slowed down or held as the daemon's newest report says.
#pragma once

#include <array>
#include <controller_interface/chainable_controller_interface.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <std_srvs/srv/trigger.hpp>
#include <string>
#include <vector>

#include "limiter.hpp"
#include "permit_reader.hpp"

namespace clearance_control {

// The speeds of the last updates.
class SpeedHistory {
 public:
  void forget() noexcept { count_ = 0; }
  void add(std::int64_t at_ns, double speed) noexcept {
    entries_[count_++ % entries_.size()] = {at_ns, speed};
  }
  // The least speed that was in force since then; 0 if that is not known.
  [[nodiscard]] double least_since(std::int64_t since_ns) const noexcept;

 private:
  struct Entry {
    std::int64_t at_ns = 0;
    double speed = 0.0;
  };
  std::array<Entry, 512> entries_;
  std::size_t count_ = 0;
};

class ClearanceLimiter : public controller_interface::ChainableControllerInterface {
 public:
  controller_interface::CallbackReturn on_init() override;
  controller_interface::CallbackReturn on_configure(const rclcpp_lifecycle::State&) override;
  controller_interface::CallbackReturn on_activate(const rclcpp_lifecycle::State&) override;
  controller_interface::CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) override;
  controller_interface::CallbackReturn on_cleanup(const rclcpp_lifecycle::State&) override;
  controller_interface::InterfaceConfiguration command_interface_configuration() const override;
  controller_interface::InterfaceConfiguration state_interface_configuration() const override;

 protected:
  std::vector<hardware_interface::CommandInterface::SharedPtr> on_export_reference_interfaces_list()
      override;
  std::vector<hardware_interface::StateInterface::SharedPtr> on_export_state_interfaces_list()
      override;
  bool on_set_chained_mode(bool chained) override;
  controller_interface::return_type update_reference_from_subscribers(
      const rclcpp::Time&, const rclcpp::Duration&) override;
  controller_interface::return_type update_and_write_commands(const rclcpp::Time&,
                                                              const rclcpp::Duration&) override;

 private:
  void read_parameters();
  void forget_references();
  [[nodiscard]] std::vector<std::string> interface_names(const std::string& interface) const;
  [[nodiscard]] Permitted permitted(std::int64_t now_ns, Cause& cause) noexcept;

  std::vector<std::string> joints_;
  std::string interface_;  // "position" or "velocity"
  std::optional<Limiter> limiter_;
  std::unique_ptr<PermitReader> permits_;
  SpeedHistory speeds_;
  std::vector<double> references_, commands_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr acknowledge_;
};

}  // namespace clearance_control
