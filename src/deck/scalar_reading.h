#pragma once
// Reading of numbers, texts and formulas, shared by all value types.

#include <string>

#include "deck/key.h"

namespace sphgeo {

/// "expected a length such as 0.5 m, got 'abc'"; always false, for `return`.
bool wrong_kind(const Node& node, const std::string& expected, const std::string& path,
                DeckReading& reading);

/// A number in SI: plain, with a unit, or a formula of deck variables; checks unit and, if asked,
/// range.
bool read_number(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
                 double& out, bool check_range = true);

/// Deck variables: any unit, no range.
bool read_variable(const Node& node, const std::string& path, DeckReading& reading, double& out);

/// A text: quoted, or plain and not a number, true, false or nothing.
bool read_text(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
               std::string& out);

/// A number, a quantity, or a formula of the names the key allows.
bool read_formula(const Node& node, const Key& key, const std::string& path, DeckReading& reading,
                  Expression& out);

/// Reports a formula's error once per unknown name; always false.
bool formula_failed(const FormulaError& e, const Node& node, const std::string& path,
                    DeckReading& reading);

/// What a number under this key looks like: "a length such as 0.5 m".
std::string number_words(const Key& key);

/// Whether a plain scalar of this text would be something else than a text.
bool looks_like_no_text(const std::string& text);

/// Whether the text is one name: letters, digits and _, not starting with a digit.
bool is_one_name(const std::string& text);

/// Fills `variables` of the reading from the mapping under `variables:`, in order.
void read_variables(const Node& node, DeckReading& reading);

}  // namespace sphgeo
