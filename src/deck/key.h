#pragma once
// One declared key of a deck section, and the declared section: everything about them that does not
// depend on a C++ type, so that the templates over it stay thin.

#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "deck/check_context.h"
#include "deck/expression.h"
#include "deck/node.h"
#include "deck/unit.h"

namespace sphgeo {

using Json = nlohmann::ordered_json;

class Key;

/// State of one reading of a deck: findings, names that formulas may use, and the rules to run once
/// the structure is correct.
struct DeckReading {
  DeckReading(Diagnostics& findings, Places& where) : found(findings), places(where) {}

  Diagnostics& found;
  Places& places;
  Variables variables;
  int dimension = 0;  ///< 0 while unknown: points of two and of three numbers are both accepted
  double resolution = 0.0;  ///< particle spacing (m), 0 while unknown
  std::string main_file;    ///< name of the main deck in findings
  std::string folder;       ///< of the main deck; paths given by --set count from it too
  std::vector<std::function<void()>> rules;
  bool variables_unreadable = false;     ///< the section as a whole: unknown names follow from it
  std::set<std::string> reported_names;  ///< unknown variables already reported

  /// The folder that relative paths in this file (or override) count from.
  std::string folder_of(const std::string& file) const;
  void error(std::string id, const Place& at, const std::string& path, std::string message,
             std::string help = {}) {
    found.error(std::move(id), at, path, std::move(message), std::move(help));
  }
};

/// How values are written back.
struct WriteStyle {
  bool for_hash = false;  ///< leave out keys that may change on resume, and the folders of files
};

/// How one C++ type is read from a node, written back and described.
class ValueType {
 public:
  virtual ~ValueType() = default;
  /// Reads into `out`; on failure reports (once) and returns false.
  virtual bool read(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
                    void* out) const = 0;
  virtual Node write(const void* value, const WriteStyle& style) const = 0;
  /// JSON Schema of the value; definitions of registries go to `definitions`.
  virtual Json json(const Key& key, Json& definitions) const = 0;
  /// "a length such as 0.5 m", "a list of points": what the deck should contain here.
  virtual std::string words(const Key& key) const = 0;
};

/// A numeric range; infinite bounds are none.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool contains(double v) const;
  bool bounded() const;
  /// "greater than 0", "from 0 to 1", "at least 2".
  std::string words(const Unit& unit) const;
};

/// A declared key. The modifiers return the key itself so that they chain.
class Key {
 public:
  Key(std::string name, const ValueType& type, Unit unit, bool required, std::string sentence,
      std::function<void*(void*)> member)
      : name_(std::move(name)),
        type_(&type),
        unit_(unit),
        required_(required),
        sentence_(std::move(sentence)),
        member_(std::move(member)) {}

  // Modifiers. Ranges hold for every component of a vector and every element of a list.
  Key& above(double x) {
    range_.low = x;
    range_.low_open = true;
    return *this;
  }
  Key& at_least(double x) {
    range_.low = x;
    range_.low_open = false;
    return *this;
  }
  Key& below(double x) {
    range_.high = x;
    range_.high_open = true;
    return *this;
  }
  Key& at_most(double x) {
    range_.high = x;
    range_.high_open = false;
    return *this;
  }
  /// The only texts allowed (for std::string, lists of it, and WordOrExpression).
  Key& choices(std::vector<std::string> names) {
    choices_ = std::move(names);
    return *this;
  }
  /// The number of elements a list may have.
  Key& items(int least, int most = std::numeric_limits<int>::max()) {
    least_items_ = least;
    most_items_ = most;
    return *this;
  }
  Key& changeable_on_resume() {
    changeable_ = true;
    return *this;
  }
  /// The paper's equation, such as "Eq. 63".
  Key& equation(std::string where) {
    equation_ = std::move(where);
    return *this;
  }
  /// Which of x, y, z, t a formula may use (default "xyzt").
  Key& only_of(std::string names) {
    formula_names_ = std::move(names);
    return *this;
  }
  /// Keeps the y component in 2D, for axes of rotation; otherwise the reader sets y = 0 there.
  Key& keep_y() {
    keep_y_ = true;
    return *this;
  }
  /// A single number a stands for the vector (0, 0, -a), as for gravity.
  Key& downward() {
    downward_ = true;
    return *this;
  }

  const std::string& name() const { return name_; }
  const ValueType& type() const { return *type_; }
  const Unit& unit() const { return unit_; }
  bool required() const { return required_; }
  const std::string& sentence() const { return sentence_; }
  const std::string& equation() const { return equation_; }
  const Range& range() const { return range_; }
  const std::vector<std::string>& choices() const { return choices_; }
  int least_items() const { return least_items_; }
  int most_items() const { return most_items_; }
  bool is_changeable_on_resume() const { return changeable_; }
  const std::string& formula_names() const { return formula_names_; }
  bool keeps_y() const { return keep_y_; }
  bool is_downward() const { return downward_; }
  /// The member of `object` that this key fills.
  void* member_of(void* object) const { return member_(object); }
  const void* member_of(const void* object) const { return member_(const_cast<void*>(object)); }

 private:
  std::string name_;
  const ValueType* type_;
  Unit unit_;
  bool required_;
  std::string sentence_;
  std::function<void*(void*)> member_;
  Range range_;
  std::vector<std::string> choices_;
  int least_items_ = 0;
  int most_items_ = std::numeric_limits<int>::max();
  bool changeable_ = false;
  std::string equation_;
  std::string formula_names_ = "xyzt";
  bool keep_y_ = false;
  bool downward_ = false;
};

/// A declared section without its C++ type.
class SchemaCore {
 public:
  SchemaCore(std::string type_name, std::string sentence)
      : type_name_(std::move(type_name)), sentence_(std::move(sentence)) {}

  const std::string& type_name() const { return type_name_; }
  const std::string& sentence() const { return sentence_; }
  const std::deque<Key>& keys() const { return keys_; }
  const std::vector<std::function<void(void*, CheckContext&)>>& rules() const { return rules_; }
  /// Keys that are removed from the mapping before it is read; suggested for misspelt keys.
  const std::vector<std::string>& taken_before() const { return taken_before_; }

 protected:
  std::string type_name_;
  std::string sentence_;
  std::vector<std::string> taken_before_;
  std::deque<Key> keys_;  // a deque: references handed out stay valid
  std::vector<std::function<void(void*, CheckContext&)>> rules_;
};

/// A schema together with the object it describes.
struct SchemaPart {
  const SchemaCore* schema = nullptr;
  void* object = nullptr;
};

/// Fills the objects from one mapping; several parts share it (keys common to an interface and
/// those of the type). `extra` names keys that the caller reads itself, such as "type".
bool read_mapping(const Node& node, const std::vector<SchemaPart>& parts, const std::string& path,
                  DeckReading& reading, const std::vector<std::string>& extra = {});

/// Writes all keys of the parts, defaults included.
void write_mapping(Node& out, const std::vector<SchemaPart>& parts, const WriteStyle& style);

/// Adds properties, required keys and defaults of the parts to a JSON Schema object.
void json_mapping(Json& out, const std::vector<SchemaPart>& parts, Json& definitions);

}  // namespace sphgeo
