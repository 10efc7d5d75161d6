#include "deck/unit.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/text.h"

namespace sphgeo {

namespace {

struct Symbol {
  std::string_view text;
  double factor;
  Unit dimension;
};

constexpr double degree = std::numbers::pi / 180.0;

/// Every symbol a unit may be made of; powers, products and quotients follow by parsing.
constexpr std::array symbols{
    Symbol{"m", 1, unit::length},        Symbol{"km", 1e3, unit::length},
    Symbol{"dm", 0.1, unit::length},     Symbol{"cm", 0.01, unit::length},
    Symbol{"mm", 1e-3, unit::length},    Symbol{"um", 1e-6, unit::length},
    Symbol{"s", 1, unit::time},          Symbol{"ms", 1e-3, unit::time},
    Symbol{"us", 1e-6, unit::time},      Symbol{"min", 60, unit::time},
    Symbol{"h", 3600, unit::time},       Symbol{"day", 86400, unit::time},
    Symbol{"kg", 1, unit::mass},         Symbol{"g", 1e-3, unit::mass},
    Symbol{"t", 1e3, unit::mass},        Symbol{"Pa", 1, unit::pressure},
    Symbol{"hPa", 1e2, unit::pressure},  Symbol{"kPa", 1e3, unit::pressure},
    Symbol{"MPa", 1e6, unit::pressure},  Symbol{"GPa", 1e9, unit::pressure},
    Symbol{"bar", 1e5, unit::pressure},  Symbol{"mbar", 1e2, unit::pressure},
    Symbol{"mPa", 1e-3, unit::pressure}, Symbol{"N", 1, unit::force},
    Symbol{"mN", 1e-3, unit::force},     Symbol{"kN", 1e3, unit::force},
    Symbol{"MN", 1e6, unit::force},      Symbol{"rad", 1, unit::angle},
    Symbol{"deg", degree, unit::angle},  Symbol{"Hz", 1, unit::frequency},
    Symbol{"kHz", 1e3, unit::frequency}, Symbol{"J", 1, unit::energy},
    Symbol{"kJ", 1e3, unit::energy},     Symbol{"l", 1e-3, unit::volume},
    Symbol{"%", 0.01, unit::none},       Symbol{"1", 1, unit::none},
};

const Symbol* find_symbol(std::string_view text) {
  for (const Symbol& s : symbols) {
    if (s.text == text) return &s;
  }
  return nullptr;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The length of a well-formed decimal number at the start of the text, 0 if there is none.
std::size_t number_length(std::string_view t) {
  std::size_t k = !t.empty() && (t[0] == '+' || t[0] == '-') ? 1 : 0;
  const auto digits = [&] {
    const std::size_t from = k;
    while (k < t.size() && is_digit(t[k])) ++k;
    return k - from;
  };
  std::size_t count = digits();
  if (k < t.size() && t[k] == '.') {
    ++k;
    count += digits();
  }
  if (count == 0) return 0;
  if (k < t.size() && (t[k] == 'e' || t[k] == 'E')) {
    const std::size_t mantissa = k++;
    if (k < t.size() && (t[k] == '+' || t[k] == '-')) ++k;
    if (digits() == 0) k = mantissa;
  }
  return k;
}

NumberText refused(std::string why) { return {NumberText::Status::refused, 0.0, std::move(why)}; }

bool is_infinity_or_nan(std::string_view text) {
  std::string t = lower_case(text);
  if (!t.empty() && (t[0] == '+' || t[0] == '-')) t.erase(0, 1);
  if (!t.empty() && t[0] == '.') t.erase(0, 1);
  return t == "inf" || t == "infinity" || t == "nan";
}

}  // namespace

std::optional<UnitText> parse_unit(std::string_view text) {
  text = trimmed(text);
  int m = 0, kg = 0, s = 0, angle = 0;
  UnitText out;
  bool divide = false;
  std::size_t k = 0;
  while (k < text.size()) {
    std::size_t end = k;
    while (end < text.size() && is_letter(text[end])) ++end;
    if (end == k) ++end;  // "%" or "1"
    const Symbol* symbol = find_symbol(text.substr(k, end - k));
    if (symbol == nullptr) return std::nullopt;
    k = end;
    int power = 1;
    if (k < text.size() && text[k] == '^') ++k;
    bool negative = false;
    if (k + 1 < text.size() && text[k] == '-' && is_digit(text[k + 1])) {
      negative = true;
      ++k;
    }
    if (k < text.size() && is_digit(text[k])) power = text[k++] - '0';
    else if (k > end) return std::nullopt;  // "^" without a power
    if (negative) power = -power;
    if (divide) power = -power;
    const double inverse = std::round(1.0 / symbol->factor);
    const bool divides = symbol->factor < 1.0 && std::abs(inverse * symbol->factor - 1.0) < 1e-12;
    const double scale = std::pow(divides ? inverse : symbol->factor, std::abs(power));
    (divides == (power > 0) ? out.divisor : out.factor) *= scale;
    m += power * symbol->dimension.m;
    kg += power * symbol->dimension.kg;
    s += power * symbol->dimension.s;
    if (symbol->dimension.angle) angle += power;
    // What joins two symbols: a slash divides by the next one only.
    divide = false;
    if (k == text.size()) break;
    while (k < text.size() && text[k] == ' ') ++k;
    if (k < text.size() && (text[k] == '/' || text[k] == '*')) {
      divide = text[k++] == '/';
      while (k < text.size() && text[k] == ' ') ++k;
    } else if (text[k - 1] != ' ') {
      return std::nullopt;
    }
    if (k == text.size()) return std::nullopt;  // a joint and nothing after it
  }
  constexpr int most = 9;
  if (text.empty() || std::abs(m) > most || std::abs(kg) > most || std::abs(s) > most) {
    return std::nullopt;
  }
  if (angle < 0 || angle > 1) return std::nullopt;
  out.dimension = {static_cast<signed char>(m), static_cast<signed char>(kg),
                   static_cast<signed char>(s), angle == 1, ""};
  return out;
}

std::string dimension_words(const Unit& u) {
  struct Named {
    Unit dimension;
    std::string_view words;
  };
  static constexpr std::array names{
      Named{unit::none, "a number"},
      Named{unit::length, "a length"},
      Named{unit::area, "an area"},
      Named{unit::volume, "a volume"},
      Named{unit::time, "a time"},
      Named{unit::mass, "a mass"},
      Named{unit::speed, "a speed"},
      Named{unit::acceleration, "an acceleration"},
      Named{unit::density, "a density"},
      Named{unit::pressure, "a pressure"},
      Named{unit::force, "a force"},
      Named{unit::viscosity, "a viscosity"},
      Named{unit::angle, "an angle"},
      Named{unit::rate, "a rate"},
      Named{unit::angular_speed, "an angular speed"},
  };
  for (const Named& n : names) {
    if (n.dimension.same_dimension(u)) return std::string(n.words);
  }
  return "a value";
}

NumberText parse_number(std::string_view raw) {
  const std::string_view text = trimmed(raw);
  if (text.empty()) return {};
  if (is_infinity_or_nan(text)) return refused("is not a finite number");
  const std::size_t length = number_length(text);
  const std::size_t sign = text[0] == '+' || text[0] == '-' ? 1 : 0;
  const auto digit_at = [&](std::size_t k) { return k < text.size() && is_digit(text[k]); };
  if (text.size() > sign + 1 && text[sign] == '0') {
    const char next = text[sign + 1];
    if (is_digit(next)) return refused("starts with 0, which some YAML readers take as octal");
    if ((next == 'x' || next == 'o' || next == 'b') && text.size() > sign + 2 &&
        (digit_at(sign + 2) || is_letter(text[sign + 2]))) {
      return refused("is no decimal number");
    }
  }
  if (length == 0) return {};
  if (length < text.size()) {
    const std::string_view rest = text.substr(length);
    if ((rest[0] == '_' || rest[0] == ':') && rest.size() > 1 && is_digit(rest[1])) {
      return refused("is read differently by different YAML readers");
    }
    return {};
  }
  const std::string_view digits = text.substr(text[0] == '+' ? 1 : 0);
  double value = 0.0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (problem == std::errc::result_out_of_range) {
    return refused("is too large or too small for a number in double precision");
  }
  if (problem != std::errc{} || end != digits.data() + digits.size()) return {};
  // A mantissa that is not zero must not become zero or lose digits near it.
  if (!std::isfinite(value)) return refused("is too large for a number in double precision");
  if (value != 0.0 && !std::isnormal(value)) {
    return refused("is too small for a number in double precision");
  }
  return {NumberText::Status::number, value, {}};
}

QuantityText split_quantity(std::string_view raw) {
  const std::string_view text = trimmed(raw);
  const std::size_t cut = number_length(text);
  // What is refused as a number is so with a unit, too: "010 m", "1:30".
  const NumberText whole = parse_number(text);
  if (cut == 0 || whole.status == NumberText::Status::refused) return {whole, {}};
  const std::string_view rest = trimmed(text.substr(cut));
  if (rest.empty() || cut == text.size()) return {parse_number(text), {}};
  const bool spaced = text[cut] == ' ' || text[cut] == '\t';
  // "2*L" and "1 - x" are formulas; "1/s" after a blank is a unit.
  const bool begins_unit = is_letter(rest[0]) || rest[0] == '%' ||
                           (spaced && rest[0] == '1' && rest.size() > 1 && rest[1] == '/');
  if (!begins_unit) return {{}, {}};
  return {parse_number(text.substr(0, cut)), std::string(rest)};
}

double parse_quantity(std::string_view text, const Unit& wanted) {
  const QuantityText q = split_quantity(text);
  if (q.number.status == NumberText::Status::refused) {
    throw std::invalid_argument(fmt::format("'{}' {}", trimmed(text), q.number.why));
  }
  if (q.number.status == NumberText::Status::not_a_number) {
    throw std::invalid_argument(fmt::format("'{}' is not a number", trimmed(text)));
  }
  if (q.unit.empty()) return q.number.value;
  const std::optional<UnitText> u = parse_unit(q.unit);
  if (!u) throw std::invalid_argument(fmt::format("unknown unit '{}'", q.unit));
  if (!u->dimension.same_dimension(wanted)) {
    throw std::invalid_argument(fmt::format("'{}' is {}, but {} is expected", trimmed(text),
                                            dimension_words(u->dimension),
                                            dimension_words(wanted)));
  }
  const double value = q.number.value * u->factor / u->divisor;
  if (!std::isfinite(value) || (value != 0.0 && !std::isnormal(value))) {
    throw std::invalid_argument(
        fmt::format("'{}' is too large or too small for a number", trimmed(text)));
  }
  return value;
}

std::string nearest_unit(std::string_view text) {
  std::vector<std::string> names;
  for (const Symbol& s : symbols) names.emplace_back(s.text);
  for (const char* composed : {"m/s", "km/h", "m/s2", "kg/m3", "g/cm3", "t/m3", "Pa s", "mPa s",
                               "1/s", "m2", "m3", "rad/s", "N/m", "m3/s", "m2/s"}) {
    names.emplace_back(composed);
  }
  return nearest_name(text, names);
}

}  // namespace sphgeo
