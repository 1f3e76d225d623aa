// Joint positions as CSV: the column t_ns, and a column for every joint under the joint's name.
//
// Times are integers in ns that do not decrease, positions are in rad or m. A column NAME/velocity
// holds the velocity of that joint. Other columns are left out. The file is plain or gzip.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "monitor/files/table.hpp"
#include "monitor/intake/slow_inputs.hpp"
#include "monitor/recording/given_joints.hpp"
#include "monitor/recording/input_log.hpp"

namespace clearance {

// All rows belong to one source, 'csv'.
class JointCsvLog final : public InputLog {
 public:
  JointCsvLog(const std::filesystem::path& file, const Scene& scene,
              const InputLogOptions& options);

  [[nodiscard]] bool next(LoggedBatch& batch) override;
  [[nodiscard]] const std::string& error() const noexcept override { return error_; }
  [[nodiscard]] bool readable() const noexcept override { return sequence_ > 0; }
  [[nodiscard]] double progress() const noexcept override { return error_.empty() ? 0.0 : 1.0; }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  struct Joint {
    std::uint32_t variable = 0;
    std::size_t column = 0;  // of the table
    std::optional<std::size_t> velocity;
  };

  // Turns the news of SlowInputs into notes.
  struct SlowNotes final : public Outlet {
    void give(PoseBatch&, std::uint64_t, std::size_t) override {}
    void tell(News news) override { texts.push_back(std::move(news.text)); }
    std::vector<std::string> texts;
  };

  void choose_columns();

  const Scene& scene_;
  std::filesystem::path file_;
  std::vector<std::string> header_;
  std::vector<std::string_view> columns_;  // into header_
  std::vector<Joint> joints_;
  std::vector<std::string> left_out_;
  GivenJoints given_;
  std::map<std::string, double> given_positions_;
  std::set<std::string> heard_;  // joints
  std::optional<CsvTable> table_;
  std::optional<LoggedBatch> given_batch_;
  SlowInputs slow_;
  SlowNotes slow_notes_;
  std::uint64_t sequence_ = 0;
  std::string error_;
};

}  // namespace clearance
