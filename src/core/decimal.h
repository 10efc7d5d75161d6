#pragma once
// Numbers of text files, with a point, whatever the locale says.

#include <optional>
#include <string>
#include <string_view>

namespace sphgeo {

/// The number that the text is: digits with or without one sign, point and exponent; also infinite
/// ones, and `nan` in capitals or with a sign. Nothing for other text, and for numbers that no
/// double holds (1e999, 1e-400).
std::optional<double> read_decimal(std::string_view text);

/// Why read_decimal has nothing for the text, "'1e-400' is too close to zero for a number: write
/// 0"; the text is shortened.
std::string why_no_decimal(std::string_view text);

}  // namespace sphgeo
