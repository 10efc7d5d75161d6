#include "report/markup.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "core/text.h"

namespace sphgeo {

std::string html_escaped(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : printable(text, "\n")) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_escaped(std::string_view json) {
  std::string out;
  out.reserve(json.size());
  // A '<' of JSON stands in a string, where it may be written by its number.
  for (const char c : json) {
    if (c == '<') out += "\\u003c";
    else out += c;
  }
  return out;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[(group >> (18 - 6 * k)) & 63u] : '=';
  }
  return out;
}

std::string raised(int exponent) {
  constexpr const char* digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (const char c : std::to_string(exponent)) out += c == '-' ? "⁻" : digits[c - '0'];
  return out;
}

std::string unit_text(std::string_view unit) {
  std::string out;
  if (unit == "1") return out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const bool power =
        i > 0 && unit[i] >= '0' && unit[i] <= '9' &&
        ((unit[i - 1] >= 'a' && unit[i - 1] <= 'z') || (unit[i - 1] >= 'A' && unit[i - 1] <= 'Z'));
    out += power ? raised(unit[i] - '0') : std::string(1, unit[i]);
  }
  return out;
}

std::string number_text(double value, int digits) {
  if (!std::isfinite(value)) return "–";
  if (value == 0) return "0";
  const std::string scientific = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  const auto e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  std::string text;
  if (exponent < -4 || exponent >= 6) {
    text = scientific.substr(0, e);
    if (text.find('.') != std::string::npos) {
      text.erase(text.find_last_not_of('0') + 1);
      if (text.back() == '.') text.pop_back();
    }
    text = (text == "1" ? "" : text + "×") + "10" + raised(exponent);
  } else {
    text = fmt::format("{:.{}g}", std::abs(value), std::max(digits, exponent + 1));
  }
  return (value < 0 ? "−" : "") + text;
}

std::string count_text(double value) {
  if (!std::isfinite(value)) return "–";
  const std::string digits = fmt::format("{:.0f}", std::abs(value));
  std::string out = value < 0 && digits != "0" ? "−" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) out += "\u202f";
    out += digits[i];
  }
  return out;
}

}  // namespace sphgeo
