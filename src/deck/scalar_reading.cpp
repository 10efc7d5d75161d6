#include "deck/scalar_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/text.h"

namespace sphgeo {

namespace {

std::string example_of(const Unit& u) {
  if (u.same_dimension(unit::none)) return {};
  if (u.same_dimension(unit::angle)) return " such as 30 deg";
  if (u.same_dimension(unit::pressure)) return " such as 18 kPa";
  return fmt::format(" such as 0.5 {}", u.symbol);
}

/// The number of a quantity ("18 kPa"), reported when malformed. Empty: it is no quantity at all.
std::optional<bool> read_quantity(const Node& node, const Unit* wanted, const std::string& path,
                                  DeckReading& reading, double& out) {
  using Status = NumberText::Status;
  const QuantityText q = split_quantity(node.text);
  if (q.number.status == Status::not_a_number) return std::nullopt;
  if (q.number.status == Status::refused) {
    reading.error("E019", node.place, path, fmt::format("{} {}", node.words(), q.number.why),
                  "write a finite decimal number such as 8, 0.01 or 1e-3");
    return false;
  }
  out = q.number.value;
  if (q.unit.empty()) return true;
  const std::optional<UnitText> u = parse_unit(q.unit);
  if (!u) {
    const std::string near = nearest_unit(q.unit);
    reading.error("E013", node.place, path, fmt::format("unknown unit '{}'", q.unit),
                  !near.empty()       ? fmt::format("did you mean '{}'?", near)
                  : wanted != nullptr ? fmt::format("the SI unit is {}", wanted->symbol)
                                      : std::string());
    return false;
  }
  if (wanted != nullptr && !u->dimension.same_dimension(*wanted)) {
    reading.error("E013", node.place, path,
                  fmt::format("expected {}{}, got '{}', which is {}", dimension_words(*wanted),
                              example_of(*wanted), node.text, dimension_words(u->dimension)),
                  fmt::format("the SI unit is {}", wanted->symbol));
    return false;
  }
  out = out * u->factor / u->divisor;
  if (std::isfinite(out) && (out == 0.0 || std::isnormal(out))) return true;
  reading.error("E019", node.place, path,
                fmt::format("{} is too large or too small for a number", node.words()));
  return false;
}

bool in_range(double value, const Node& node, const Key& key, const std::string& path,
              DeckReading& reading) {
  if (key.range().contains(value)) return true;
  reading.error("E014", node.place, path, fmt::format("{} is out of range", node.words()),
                fmt::format("must be {}", key.range().words(key.unit())));
  return false;
}

/// A text in which no formula can be meant: words without digits, operators or known names.
bool is_no_formula(const Node& node, const FormulaError& e, const DeckReading& reading) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ' ' || c == '"' ||
           c == '\'' || c == '.' || c == ',' || c == '-' || c == '/';
  };
  if (!e.unknown_name.empty()) {
    std::vector<std::string> names;
    for (const auto& v : reading.variables.values) names.push_back(v.first);
    // When the variables could not be read, any name may be one of them.
    return !reading.variables_unreadable && is_one_name(node.text) && node.text.size() > 1 &&
           reading.variables.find(node.text) == nullptr && nearest_name(node.text, names).empty();
  }
  return std::all_of(node.text.begin(), node.text.end(), plain);
}

}  // namespace

bool wrong_kind(const Node& node, const std::string& expected, const std::string& path,
                DeckReading& reading) {
  reading.error("E010", node.place, path,
                fmt::format("expected {}, got {}", expected, node.words()));
  return false;
}

bool is_one_name(const std::string& text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !text.empty() && letter(text[0]) && std::all_of(text.begin(), text.end(), [&](char c) {
    return letter(c) || (c >= '0' && c <= '9');
  });
}

std::string number_words(const Key& key) {
  return dimension_words(key.unit()) + example_of(key.unit());
}

bool looks_like_no_text(const std::string& text) {
  const std::string t = lower_case(text);
  for (const char* word : {"", "~", "null", "true", "false", "yes", "no", "on", "off"}) {
    if (t == word) return true;
  }
  return parse_number(text).status != NumberText::Status::not_a_number;
}

bool formula_failed(const FormulaError& e, const Node& node, const std::string& path,
                    DeckReading& reading) {
  if (!e.unknown_name.empty()) {
    // A failed or unknown variable is reported once, however often it is used.
    const double* value = reading.variables.find(e.unknown_name);
    if (value != nullptr && std::isnan(*value)) return false;
    if (value == nullptr && reading.variables_unreadable) return false;
    const bool coordinate = e.unknown_name.size() == 1 && value == nullptr &&
                            std::string("xyzt").find(e.unknown_name) != std::string::npos;
    if (!coordinate && !reading.reported_names.insert(e.unknown_name).second) return false;
  }
  Place at = node.place;
  if (at.line > 0) at.column += e.offset + (node.quoted ? 1 : 0);
  reading.error("E017", at, path, e.what(), e.help);
  return false;
}

bool read_number(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
                 double& out, bool check_range) {
  if (node.kind != Node::Kind::scalar) return wrong_kind(node, number_words(key), path, reading);
  double value = 0.0;
  if (const auto done = read_quantity(node, &key.unit(), path, reading, value)) {
    if (!*done) return false;
  } else {
    try {
      value = evaluate_constant(node.text, reading.variables);
    } catch (const FormulaError& e) {
      if (is_no_formula(node, e, reading))
        return wrong_kind(node, number_words(key), path, reading);
      return formula_failed(e, node, path, reading);
    }
  }
  if (check_range && !in_range(value, node, key, path, reading)) return false;
  out = value;
  return true;
}

bool read_variable(const Node& node, const std::string& path, DeckReading& reading, double& out) {
  if (node.kind != Node::Kind::scalar) return wrong_kind(node, "a number", path, reading);
  if (const auto done = read_quantity(node, nullptr, path, reading, out)) return *done;
  try {
    out = evaluate_constant(node.text, reading.variables);
    return true;
  } catch (const FormulaError& e) {
    if (is_no_formula(node, e, reading)) return wrong_kind(node, "a number", path, reading);
    return formula_failed(e, node, path, reading);
  }
}

bool read_text(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
               std::string& out) {
  const std::vector<std::string>& choices = key.choices();
  const std::string expected =
      choices.empty() ? "a text" : fmt::format("one of {}", in_words(choices, "or"));
  if (node.kind != Node::Kind::scalar) return wrong_kind(node, expected, path, reading);
  if (!node.quoted && looks_like_no_text(node.text)) {
    reading.error("E010", node.place, path,
                  fmt::format("expected {}, got {}", expected, node.words()),
                  choices.empty() ? "put a text that looks like something else in quotes" : "");
    return false;
  }
  if (!choices.empty() && std::find(choices.begin(), choices.end(), node.text) == choices.end()) {
    reading.error("E015", node.place, path,
                  fmt::format("expected {}, got {}", expected, node.words()),
                  suggestion(node.text, choices, "valid"));
    return false;
  }
  out = node.text;
  return true;
}

bool read_formula(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
                  Expression& out) {
  const std::string expected = "a formula or " + number_words(key);
  if (node.kind != Node::Kind::scalar) return wrong_kind(node, expected, path, reading);
  double value = 0.0;
  if (const auto done = read_quantity(node, &key.unit(), path, reading, value)) {
    if (!*done || !in_range(value, node, key, path, reading)) return false;
    out = Expression(value);
    return true;
  }
  try {
    const Expression e = Expression::parse(node.text, reading.variables, key.formula_names());
    if (e.is_constant() && !in_range(e(Vec3::Zero(), 0.0), node, key, path, reading)) return false;
    out = e;
    return true;
  } catch (const FormulaError& e) {
    if (is_no_formula(node, e, reading)) return wrong_kind(node, expected, path, reading);
    return formula_failed(e, node, path, reading);
  }
}

void read_variables(const Node& node, DeckReading& reading) {
  if (node.kind != Node::Kind::map) {
    wrong_kind(node, "a mapping of names to numbers", "variables", reading);
    reading.variables_unreadable = true;
    return;
  }
  for (const Entry& entry : node.entries) {
    const std::string path = join_path("variables", entry.key);
    reading.places[path] = entry.place;
    if (entry.key.rfind("x-", 0) == 0) continue;
    if (const std::string why = why_no_variable(entry.key); !why.empty()) {
      reading.error("E023", entry.place, "variables",
                    fmt::format("variable '{}' {}", entry.key, why), "choose another name");
      reading.reported_names.insert(entry.key);
      continue;
    }
    double value = 0.0;
    // Later formulas may name a failed variable without a second error.
    if (!read_variable(entry.value, path, reading, value)) value = std::nan("");
    reading.variables.values.emplace_back(entry.key, value);
  }
}

}  // namespace sphgeo
