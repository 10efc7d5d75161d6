// How numbers, texts, points, formulas and files are read, written and described.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "deck/scalar_reading.h"
#include "deck/schema.h"

namespace sphgeo {

namespace {

void json_range(Json& out, const Range& r) {
  // Parsing the exact text keeps whole numbers whole: 2, not 2.0.
  if (std::isfinite(r.low))
    out[r.low_open ? "exclusiveMinimum" : "minimum"] = Json::parse(exact(r.low));
  if (std::isfinite(r.high))
    out[r.high_open ? "exclusiveMaximum" : "maximum"] = Json::parse(exact(r.high));
}

/// A number, or a text that holds a unit or a formula; the range binds plain numbers only.
Json json_number(const Key& key, const char* type) {
  Json out{{"type", Json::array({type, "string"})}};
  json_range(out, key.range());
  return out;
}

struct RealType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    return read_number(node, key, path, reading, *static_cast<double*>(out));
  }
  Node write(const void* v, const WriteStyle&) const override {
    return Node::scalar(exact(*static_cast<const double*>(v)));
  }
  Json json(const Key& key, Json&) const override { return json_number(key, "number"); }
  std::string words(const Key& key) const override { return number_words(key); }
};

template <class T>
struct WholeType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    double value = 0.0;
    if (!read_number(node, key, path, reading, value)) return false;
    const double most = std::min(9007199254740992.0,  // 2^53: whole numbers are exact up to here
                                 static_cast<double>(std::numeric_limits<T>::max()));
    if (value != std::floor(value) || std::abs(value) > most) {
      return wrong_kind(node, "a whole number", path, reading);
    }
    *static_cast<T*>(out) = static_cast<T>(value);
    return true;
  }
  Node write(const void* v, const WriteStyle&) const override {
    return Node::scalar(fmt::format("{}", *static_cast<const T*>(v)));
  }
  Json json(const Key& key, Json&) const override { return json_number(key, "integer"); }
  std::string words(const Key&) const override { return "a whole number"; }
};

struct BoolType final : ValueType {
  bool read(const Node& node, const Key&, const std::string& path, DeckReading& reading,
            void* out) const override {
    const bool yes = node.text == "true";
    if (node.kind != Node::Kind::scalar || node.quoted || (!yes && node.text != "false")) {
      return wrong_kind(node, "true or false", path, reading);
    }
    *static_cast<bool*>(out) = yes;
    return true;
  }
  Node write(const void* v, const WriteStyle&) const override {
    return Node::scalar(*static_cast<const bool*>(v) ? "true" : "false");
  }
  Json json(const Key&, Json&) const override { return {{"type", "boolean"}}; }
  std::string words(const Key&) const override { return "true or false"; }
};

struct TextType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    return read_text(node, key, path, reading, *static_cast<std::string*>(out));
  }
  Node write(const void* v, const WriteStyle&) const override {
    const std::string& text = *static_cast<const std::string*>(v);
    return Node::scalar(text, looks_like_no_text(text) || text == "auto");
  }
  Json json(const Key& key, Json&) const override {
    Json out{{"type", "string"}};
    if (!key.choices().empty()) out["enum"] = key.choices();
    return out;
  }
  std::string words(const Key& key) const override {
    return key.choices().empty() ? "a text" : "one of " + in_words(key.choices(), "or");
  }
};

/// The y component is not used in a 2D scene.
bool ignores_y(const DeckReading& reading, const Key& key) {
  return reading.dimension == 2 && !key.keeps_y();
}

/// Checks that a node is a list of two or three components, and says which axis each stands for.
bool components(const Node& node, const std::string& expected, const std::string& path,
                DeckReading& reading, std::vector<int>& axes) {
  if (node.kind != Node::Kind::list) return wrong_kind(node, expected, path, reading);
  if (node.items.size() == 3) {
    axes = {0, 1, 2};
  } else if (node.items.size() == 2 && reading.dimension != 3) {
    axes = {0, 2};
  } else {
    const bool flat = reading.dimension == 2;
    reading.error("E020", node.place, path,
                  fmt::format("expected {}, got {}", expected, node.words()),
                  flat ? "write [x, z], or [x, y, z] with y ignored" : "write [x, y, z]");
    return false;
  }
  return true;
}

struct PointType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    Vec3 value = Vec3::Zero();
    if (key.is_downward() && node.kind == Node::Kind::scalar) {
      double down = 0.0;
      if (!read_number(node, key, path, reading, down)) return false;
      if (down != 0.0) value.z() = -down;
      *static_cast<Vec3*>(out) = value;
      return true;
    }
    std::vector<int> axes;
    if (!components(node, words(key), path, reading, axes)) return false;
    bool good = true;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string at = fmt::format("{}[{}]", path, k);
      reading.places[at] = node.items[k].place;
      const bool unused = axes[k] == 1 && ignores_y(reading, key);
      double component = 0.0;
      good &= read_number(node.items[k], key, at, reading, component, !unused);
      if (!unused) value[axes[k]] = component;
    }
    if (good) *static_cast<Vec3*>(out) = value;
    return good;
  }
  Node write(const void* v, const WriteStyle&) const override {
    const Vec3& a = *static_cast<const Vec3*>(v);
    return Node::list(
        {Node::scalar(exact(a.x())), Node::scalar(exact(a.y())), Node::scalar(exact(a.z()))});
  }
  Json json(const Key& key, Json&) const override {
    Json list{
        {"type", "array"}, {"items", json_number(key, "number")}, {"minItems", 2}, {"maxItems", 3}};
    if (!key.is_downward()) return list;
    return {{"anyOf", Json::array({json_number(key, "number"), std::move(list)})}};
  }
  std::string words(const Key& key) const override {
    return key.is_downward() ? number_words(key) + " or a vector [x, y, z] of them"
                             : "a vector [x, y, z], each component " + number_words(key);
  }
};

struct FormulaType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    return read_formula(node, key, path, reading, *static_cast<Expression*>(out));
  }
  Node write(const void* v, const WriteStyle&) const override {
    return Node::scalar(static_cast<const Expression*>(v)->text());
  }
  Json json(const Key& key, Json&) const override { return json_number(key, "number"); }
  std::string words(const Key& key) const override { return "a formula or " + number_words(key); }
};

struct FormulaVectorType final : ValueType {
  using Three = std::array<Expression, 3>;
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    std::vector<int> axes;
    if (!components(node, words(key), path, reading, axes)) return false;
    Three value;
    bool good = true;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const std::string at = fmt::format("{}[{}]", path, k);
      reading.places[at] = node.items[k].place;
      Expression component;
      good &= read_formula(node.items[k], key, at, reading, component);
      if (axes[k] != 1 || !ignores_y(reading, key)) {
        value[static_cast<std::size_t>(axes[k])] = component;
      }
    }
    if (good) *static_cast<Three*>(out) = value;
    return good;
  }
  Node write(const void* v, const WriteStyle&) const override {
    const Three& e = *static_cast<const Three*>(v);
    return Node::list(
        {Node::scalar(e[0].text()), Node::scalar(e[1].text()), Node::scalar(e[2].text())});
  }
  Json json(const Key& key, Json&) const override {
    return {
        {"type", "array"}, {"items", json_number(key, "number")}, {"minItems", 2}, {"maxItems", 3}};
  }
  std::string words(const Key& key) const override {
    return "a vector [x, y, z], each component a formula or " + number_words(key);
  }
};

struct WordOrFormulaType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    auto& value = *static_cast<WordOrExpression*>(out);
    const std::vector<std::string>& c = key.choices();
    if (node.kind == Node::Kind::scalar) {
      if (std::find(c.begin(), c.end(), node.text) != c.end()) {
        value = {node.text, Expression()};
        return true;
      }
      const bool coordinate =
          node.text.size() == 1 && key.formula_names().find(node.text) != std::string::npos;
      if (is_one_name(node.text) && !coordinate && node.text != "pi" &&
          reading.variables.find(node.text) == nullptr) {
        reading.error("E015", node.place, path,
                      fmt::format("expected {}, got {}", words(key), node.words()),
                      suggestion(node.text, c, "valid words"));
        return false;
      }
    }
    Expression formula;
    if (!read_formula(node, key, path, reading, formula)) return false;
    value = {"", formula};
    return true;
  }
  Node write(const void* v, const WriteStyle&) const override {
    const auto& value = *static_cast<const WordOrExpression*>(v);
    return Node::scalar(value.word.empty() ? value.formula.text() : value.word);
  }
  Json json(const Key& key, Json&) const override {
    return {{"anyOf", Json::array({Json{{"enum", key.choices()}}, json_number(key, "number")})}};
  }
  std::string words(const Key& key) const override {
    return fmt::format("{}, a formula or {}", fmt::join(key.choices(), ", "), number_words(key));
  }
};

struct FileType final : ValueType {
  bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
            void* out) const override {
    namespace fs = std::filesystem;
    std::string text;
    if (!read_text(node, key, path, reading, text)) return false;
    const std::string folder = reading.folder_of(node.place.file);
    std::error_code problem;
    const fs::path file = fs::absolute(fs::path(folder) / text, problem).lexically_normal();
    if (problem || !fs::is_regular_file(file, problem)) {
      reading.error("E018", node.place, path, fmt::format("file '{}' not found", text),
                    fmt::format("looked for {}", file.string()));
      return false;
    }
    static_cast<FilePath*>(out)->path = file.string();
    return true;
  }
  Node write(const void* v, const WriteStyle& style) const override {
    const std::string& path = static_cast<const FilePath*>(v)->path;
    // The hash must not change when a deck moves to another folder.
    return Node::scalar(style.for_hash ? std::filesystem::path(path).filename().string() : path,
                        looks_like_no_text(path));
  }
  Json json(const Key&, Json&) const override { return {{"type", "string"}}; }
  std::string words(const Key&) const override { return "the name of a file"; }
};

/// The reader evaluates variables before everything else; here they only enter the model.
struct VariablesType final : ValueType {
  bool read(const Node&, const Key&, const std::string&, DeckReading& reading,
            void* out) const override {
    auto& own = *static_cast<Variables*>(out) = reading.variables;
    std::erase_if(own.values, [](const auto& v) { return is_given_variable(v.first); });
    return true;
  }
  Node write(const void* v, const WriteStyle&) const override {
    Node out = Node::map();
    for (const auto& [name, value] : static_cast<const Variables*>(v)->values) {
      out.add(name, Node::scalar(exact(value)));
    }
    return out;
  }
  Json json(const Key&, Json&) const override {
    return {{"type", "object"},
            {"additionalProperties", {{"type", Json::array({"number", "string"})}}},
            {"propertyNames", {{"pattern", "^(x-.*|[A-Za-z_][A-Za-z0-9_]*)$"}}}};
  }
  std::string words(const Key&) const override { return "a mapping of names to numbers"; }
};

}  // namespace

template <>
const ValueType& value_type<double>() {
  static const RealType type;
  return type;
}
template <>
const ValueType& value_type<int>() {
  static const WholeType<int> type;
  return type;
}
template <>
const ValueType& value_type<Index>() {
  static const WholeType<Index> type;
  return type;
}
template <>
const ValueType& value_type<bool>() {
  static const BoolType type;
  return type;
}
template <>
const ValueType& value_type<std::string>() {
  static const TextType type;
  return type;
}
template <>
const ValueType& value_type<Vec3>() {
  static const PointType type;
  return type;
}
template <>
const ValueType& value_type<Expression>() {
  static const FormulaType type;
  return type;
}
template <>
const ValueType& value_type<std::array<Expression, 3>>() {
  static const FormulaVectorType type;
  return type;
}
template <>
const ValueType& value_type<FilePath>() {
  static const FileType type;
  return type;
}
template <>
const ValueType& value_type<WordOrExpression>() {
  static const WordOrFormulaType type;
  return type;
}
template <>
const ValueType& value_type<Variables>() {
  static const VariablesType type;
  return type;
}

}  // namespace sphgeo
