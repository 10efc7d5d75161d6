#include "core/decimal.h"

#include <charconv>
#include <cmath>

#include "core/text.h"

namespace sphgeo {
namespace {

template <typename T>
std::errc read(std::string_view text, T& value) {
  std::string_view digits = text;
  if (digits.starts_with('+')) {
    digits.remove_prefix(1);
    // A second sign is none: from_chars takes the '-' of "+-5".
    if (digits.starts_with('-')) return std::errc::invalid_argument;
  }
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (status == std::errc::invalid_argument || end != digits.data() + digits.size())
    return std::errc::invalid_argument;
  return status;
}

}  // namespace

std::optional<double> read_decimal(std::string_view text) {
  double value = 0;
  if (read(text, value) != std::errc()) return {};
  return value;
}

std::string why_no_decimal(std::string_view text) {
  const std::string quoted = "'" + shortened(text, 60) + "'";
  double value = 0;
  if (read(text, value) != std::errc::result_out_of_range) return quoted + " is not a number";
  // The wider exponents of a long double tell small from large, and the text where they do not.
  long double wide = 0;
  const bool known = read(text, wide) == std::errc();
  if (known ? std::abs(wide) < 1 : lower_case(text).find("e-") != std::string::npos)
    return quoted + " is too close to zero for a number: write 0";
  return quoted + " is too large for a number";
}

}  // namespace sphgeo
