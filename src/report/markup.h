#pragma once
// Text and numbers as HTML and SVG want them.

#include <string>
#include <string_view>

namespace sphgeo {

/// Text for an element or a quoted attribute: & < > " ' are written as entities; control characters
/// but newline and tab, characters that turn the direction of writing and bytes that are no UTF-8
/// become '?'.
std::string html_escaped(std::string_view text);

/// JSON for a <script> element: "</script>" and "<!--" inside of strings cannot end it.
std::string script_escaped(std::string_view json);

/// The bytes in base64, for pictures that are part of a page.
std::string base64(std::string_view bytes);

/// A number to read: `digits` significant digits, a real minus sign, powers of ten as "1.2×10⁻⁵"
/// outside of 1e-4 .. 1e6; "-" for what is not finite.
std::string number_text(double value, int digits = 4);

/// 1234567 as "1 234 567", with narrow blanks that do not break.
std::string count_text(double value);

/// A unit as it is shown: "kg/m³" for "kg/m3"; "" for "1".
std::string unit_text(std::string_view unit);

/// "⁻¹²": an exponent in raised digits.
std::string raised(int exponent);

}  // namespace sphgeo
