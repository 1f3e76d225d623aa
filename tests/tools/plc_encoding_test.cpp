// Figures as registers of clearance-plc. Oracle: rational arithmetic on the doubles themselves.
#include "tools/plc/encoding.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <set>

#include "tests/shared/random.hpp"
#include "tools/plc/register_table.hpp"

namespace clearance::plc {
namespace {

PlcRow row_of(PlcValue value, std::size_t type, std::size_t unit, double scale) {
  return {.value = value,
          .type = static_cast<std::uint8_t>(type),
          .unit = static_cast<std::uint8_t>(unit),
          .scale = scale};
}

// The number that a controller makes of the words.
double decoded(const PlcRow& row, std::uint8_t order, const Encoded& encoded) {
  std::uint32_t bits = 0;
  for (std::size_t place = 0; place < 2u * row.width().registers; ++place) {
    const std::uint16_t word = encoded.words[place / 2];
    const std::uint32_t byte = place % 2 == 0 ? word >> 8 : word & 255;
    std::size_t letter = static_cast<std::size_t>(kPlcOrders[order][place] - 'A');
    if (row.width().registers == 1) letter = letter % 2 + 2;
    bits |= byte << (8 * (3 - letter));
  }
  const std::string_view type = row.width().key;
  if (type == "float32") return std::bit_cast<float>(bits);
  if (type == "int32") return std::bit_cast<std::int32_t>(bits);
  if (type == "int16") return static_cast<std::int16_t>(bits);
  return bits;
}

TEST(PlcEncoding, IsNeverAboveTheFigureAndLessThanACountBelowIt) {
  Random random(61);
  int fitted = 0, above = 0;
  for (int i = 0; i < 20'000; ++i) {
    const bool is_length = random.chance(0.5);
    const double scale = random.chance(0.5) ? 0.1 : random.log_uniform(1e-4, 10.0);
    const PlcRow row =
        row_of(is_length ? PlcValue::kStopMargin : PlcValue::kSpeedScaling,
               random.next() % kPlcTypes.size(), (is_length ? 0 : 2) + random.next() % 2, scale);
    const auto order = static_cast<std::uint8_t>(random.next() % kPlcOrders.size());
    double value = random.sign() * random.log_uniform(1e-4, 1e6);
    if (random.chance(0.3)) value = std::round(value * row.per_si()) / row.per_si();
    const Encoded encoded = encode(row, order, value);
    const double count = decoded(row, order, encoded);
    EXPECT_EQ(count, encoded.count);
    const mpq_class exact = mpq_class(value) * mpq_class(row.per_si());
    if (!encoded.fits) {
      ++above;
      EXPECT_EQ(count, safe_end(row));
      EXPECT_GT(exact + 1, mpq_class(row.width().most));
    } else if (count > safe_end(row)) {
      ++fitted;
      EXPECT_LE(mpq_class(count), exact) << value << " x " << row.per_si();
      const mpq_class next = row.width().is_float
                                 ? mpq_class(std::nextafter(static_cast<float>(count), HUGE_VALF))
                                 : mpq_class(count) + 1;
      EXPECT_GT(next, exact) << value << " x " << row.per_si();
    } else {
      EXPECT_LT(exact, mpq_class(safe_end(row)) + 1);
    }
  }
  EXPECT_GT(fitted, 5'000);
  EXPECT_GT(above, 500);
}

TEST(PlcEncoding, KeepsWholeCountsOfTheStandardUnits) {
  const PlcRow mm = row_of(PlcValue::kLeastDistance, 0, 0, 1.0);
  const PlcRow percent = row_of(PlcValue::kSpeedScaling, 0, 2, 0.1);
  EXPECT_EQ(encode(percent, 0, 1.0).count, 1000.0);
  EXPECT_EQ(encode(percent, 0, 0.5).count, 500.0);
  for (int count = 0; count < 65536; ++count) {
    // The double nearest to a count of millimetres may be below it.
    const double at = encode(mm, 0, std::nextafter(count / 1000.0, kInfinite)).count;
    ASSERT_EQ(at, count);
  }
}

TEST(PlcEncoding, IsTheSafeEndForWhatIsNotKnownOrDoesNotFit) {
  for (std::size_t type = 0; type < kPlcTypes.size(); ++type) {
    const PlcRow margin = row_of(PlcValue::kStopMargin, type, 0, 1.0);
    const PlcRow scaling = row_of(PlcValue::kSpeedScaling, type, 2, 0.1);
    EXPECT_EQ(safe_end(margin), kPlcTypes[type].least);
    EXPECT_EQ(safe_end(scaling), 0.0);  // no controller runs backwards
    for (const double value : {std::nan(""), -kInfinite, kInfinite, -1e300, 1e300}) {
      EXPECT_EQ(decoded(margin, 0, encode(margin, 0, value)), safe_end(margin)) << value;
      EXPECT_EQ(decoded(scaling, 0, encode(scaling, 0, value)), 0.0) << value;
      EXPECT_EQ(encode(margin, 0, value).fits, !(value > 0.0)) << value;
    }
  }
}

TEST(PlcLayout, IsAnotherNumberAfterEachChangeOfTheTable) {
  PlcSettings settings;
  settings.rows = {row_of(PlcValue::kHeartbeat, 0, 0, 1.0),
                   row_of(PlcValue::kStopMargin, 0, 0, 1.0)};
  settings.rows[1].at = 7;
  std::set<std::uint16_t> numbers{layout(settings)};
  const auto expect_new = [&](auto change) {
    PlcSettings changed = settings;
    change(changed);
    EXPECT_TRUE(numbers.insert(layout(changed)).second) << describe(changed);
  };
  expect_new([](PlcSettings& s) { s.order = 1; });
  expect_new([](PlcSettings& s) { s.rows[1].at = 8; });
  expect_new([](PlcSettings& s) { s.rows[1].type = 2; });
  expect_new([](PlcSettings& s) { s.rows[1].unit = 1; });
  expect_new([](PlcSettings& s) { s.rows[1].scale = 10.0; });
  expect_new([](PlcSettings& s) { s.rows[1].zone = "people"; });
  expect_new([](PlcSettings& s) { s.rows[1].robot = "people"; });
  EXPECT_FALSE(numbers.contains(0));
}

}  // namespace
}  // namespace clearance::plc
