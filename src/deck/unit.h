#pragma once
// Units of the deck: every number is SI inside; `18 kPa` or `30 deg` is accepted where it fits.

#include <optional>
#include <string>
#include <string_view>

namespace sphgeo {

/// A dimension (powers of metre, kilogram, second; plane angle apart) and the SI symbol shown.
struct Unit {
  signed char m = 0;
  signed char kg = 0;
  signed char s = 0;
  bool angle = false;
  const char* symbol = "1";

  bool same_dimension(const Unit& o) const {
    return m == o.m && kg == o.kg && s == o.s && angle == o.angle;
  }
};

namespace unit {
inline constexpr Unit none{0, 0, 0, false, "1"};
inline constexpr Unit length{1, 0, 0, false, "m"};
inline constexpr Unit area{2, 0, 0, false, "m2"};
inline constexpr Unit volume{3, 0, 0, false, "m3"};
inline constexpr Unit time{0, 0, 1, false, "s"};
inline constexpr Unit mass{0, 1, 0, false, "kg"};
inline constexpr Unit speed{1, 0, -1, false, "m/s"};
inline constexpr Unit acceleration{1, 0, -2, false, "m/s2"};
inline constexpr Unit density{-3, 1, 0, false, "kg/m3"};
inline constexpr Unit pressure{-1, 1, -2, false, "Pa"};
inline constexpr Unit force{1, 1, -2, false, "N"};
inline constexpr Unit moment{2, 1, -2, false, "N m"};
inline constexpr Unit stiffness{0, 1, -2, false, "N/m"};
inline constexpr Unit viscosity{-1, 1, -1, false, "Pa s"};
inline constexpr Unit kinematic_viscosity{2, 0, -1, false, "m2/s"};
inline constexpr Unit angle{0, 0, 0, true, "rad"};
inline constexpr Unit angular_speed{0, 0, -1, true, "rad/s"};
inline constexpr Unit frequency{0, 0, -1, false, "Hz"};
inline constexpr Unit rate{0, 0, -1, false, "1/s"};
inline constexpr Unit energy{2, 1, -2, false, "J"};
inline constexpr Unit inertia{2, 1, 0, false, "kg m2"};
inline constexpr Unit force_density{-2, 1, -2, false, "N/m3"};
inline constexpr Unit inverse_mass{0, -1, 0, false, "1/kg"};
inline constexpr Unit drag_linear{-3, 1, -1, false, "N s/m4"};
inline constexpr Unit drag_quadratic{-4, 1, 0, false, "N s2/m5"};
inline constexpr Unit flow_rate{3, 0, -1, false, "m3/s"};
}  // namespace unit

/// What a unit text means: SI value = number * factor / divisor, and the dimension. Two whole
/// numbers rather than one fraction: 35 / 1000 is the double nearest to 0.035, 35 * 0.001 may not
/// be.
struct UnitText {
  double factor = 1.0;
  double divisor = 1.0;
  Unit dimension;
};

/// Reads "kPa", "kg/m3", "m/s^2", "Pa s", "Pa*s", "1/s", "deg", "%"; empty when a symbol is
/// unknown.
std::optional<UnitText> parse_unit(std::string_view text);

/// The dimension in words, "a length", "a pressure"; "a value in X" for rarer ones.
std::string dimension_words(const Unit& u);

/// A number of the deck, or the reason why the text is not a number.
struct NumberText {
  enum class Status { number, not_a_number, refused };
  Status status = Status::not_a_number;
  double value = 0.0;
  std::string why;  ///< for `refused`: the sentence for the user
};

/// Reads a plain number strictly: refuses inf, nan, values that overflow or vanish (1e-400), and
/// numbers that YAML readers disagree about (010, 0x1F, 1_000, 1:30).
NumberText parse_number(std::string_view text);

/// A quantity split into number and unit text ("18 kPa" -> 18, "kPa"); empty unit for a plain
/// number.
struct QuantityText {
  NumberText number;
  std::string unit;
};
QuantityText split_quantity(std::string_view text);

/// The value in SI of "18 kPa", "30 deg", "2 cm", "5 %" or a plain number.
/// Throws std::invalid_argument with a sentence when it is malformed or of another dimension.
double parse_quantity(std::string_view text, const Unit& wanted);

/// The known unit that a misspelt one most likely means, or "".
std::string nearest_unit(std::string_view text);

}  // namespace sphgeo
