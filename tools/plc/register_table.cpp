#include "tools/plc/register_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/text/fnv1a.hpp"

namespace clearance::plc {
namespace {

// In the order of PlcValue.
constexpr std::array<std::string_view, kPlcValues.size()> kMeanings = {
    "advances once per period while figures are good; 0 before the first",
    "1: the figures are good; 0: they are fail-safe",
    "why they are fail-safe; 0: they are good",
    "changes with this table: compare it with the number above",
    "writes that were refused since the start",
    "figures above what their type holds, since the start",
    "1: no zone of these is active; 0: one is, or is not known",
    "lower bound of the distance of all pairs",
    "share of the present speed that is allowed",
    "distance that is left: until the robot stands, or above S_p",
};

// "0.1 percent", or nothing for counts and flags.
std::string unit(const PlcRow& row) {
  return row.has_unit() ? fmt::format("{:.9g} {}", row.scale, kPlcUnits[row.unit].key) : "";
}

std::string line(const PlcRow& row) {
  return fmt::format("{:>7}  {:<7}  {:<11}  {:>9.9g}  {:<32}  ", row.at, row.width().key, unit(row),
                     safe_end(row), name(row));
}

double wrapped(std::uint64_t count) { return static_cast<double>(count % 65536); }

}  // namespace

std::string name(const PlcRow& row) {
  if (!row.zone.empty()) return fmt::format("zone {}: {}", row.zone, row.key().key);
  if (!row.robot.empty()) return fmt::format("robot {}: {}", row.robot, row.key().key);
  return std::string(row.key().key);
}

std::uint16_t layout(const PlcSettings& settings) {
  Fnv1a hash;
  hash.add(kPlcOrders[settings.order]);
  for (const PlcRow& row : settings.rows) hash.add(line(row));
  return static_cast<std::uint16_t>(1 + hash.value() % 65535);
}

RegisterTable::RegisterTable(const PlcSettings& settings)
    : settings_(settings), layout_(layout(settings)), rows_(settings.rows.size()) {
  const PlcRow& last = settings.rows.back();
  words_.resize(last.at + last.width().registers);
  update(HeldFigures(rows_.size(), settings.period_ns), 0);
}

double RegisterTable::value(std::size_t row, const HeldFigures& figures,
                            std::uint64_t refused_writes) const {
  switch (settings_.rows[row].value) {
    case PlcValue::kHeartbeat:
      return figures.heartbeat();
    case PlcValue::kGood:
      return figures.cause() == Cause::kNone ? 1.0 : 0.0;
    case PlcValue::kCause:
      return static_cast<double>(figures.cause());
    case PlcValue::kLayout:
      return layout_;
    case PlcValue::kRefusedWrites:
      return wrapped(refused_writes);
    case PlcValue::kMisfits:
      return wrapped(misfits_);
    default:
      return figures.values()[row];
  }
}

void RegisterTable::update(const HeldFigures& figures, std::uint64_t refused_writes) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const PlcRow& row = settings_.rows[i];
    const bool did_fit = rows_[i].fits;
    rows_[i] = encode(row, settings_.order, value(i, figures, refused_writes));
    if (did_fit && !rows_[i].fits) {
      ++misfits_;
      new_misfits_.push_back(i);
    }
    std::copy_n(rows_[i].words.begin(), row.width().registers, words_.begin() + row.at);
  }
}

std::vector<std::size_t> RegisterTable::new_misfits() { return std::exchange(new_misfits_, {}); }

std::string describe(const PlcSettings& settings) {
  const PlcRow& last = settings.rows.back();
  std::string text = fmt::format(
      "Modbus TCP, any unit identifier: functions 3 and 4 read addresses 0 to {}. All writes are "
      "refused.\nperiod {:g} ms   order of bytes {}   layout {}\n\n{:>7}  {:<7}  {:<11}  {:>9}  "
      "{:<32}  {}\n",
      last.at + last.width().registers - 1, 1e-6 * static_cast<double>(settings.period_ns),
      kPlcOrders[settings.order], layout(settings), "address", "type", "count of", "fail-safe",
      "figure", "meaning");
  for (const PlcRow& row : settings.rows)
    text += fmt::format("{}{}\n", line(row), kMeanings[static_cast<std::size_t>(row.value)]);
  text += "\ncause:";
  for (std::size_t i = 1; i < kCauses.size(); ++i) text += fmt::format(" {} {};", i, kCauses[i]);
  text.back() = '\n';
  return text;
}

}  // namespace clearance::plc
