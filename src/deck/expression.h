#pragma once
// Formulas of a deck: x, y, z, t, the deck's variables and a few functions, evaluated by muparser.

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// The deck's variables in the order of their definition. NaN stands for a variable whose own
/// definition failed: its uses are not reported again.
struct Variables {
  std::vector<std::pair<std::string, double>> values;
  const double* find(const std::string& name) const;
};

/// A formula that cannot be read. `offset` counts from the start of the formula's text.
class FormulaError : public std::runtime_error {
 public:
  FormulaError(const std::string& message, std::string hint, int at, std::string name = {})
      : std::runtime_error(message),
        help(std::move(hint)),
        offset(at),
        unknown_name(std::move(name)) {}
  std::string help;
  int offset;
  std::string unknown_name;  ///< set when the cause is an unknown or failed name
};

/// A formula of position and time; a plain number is one too. Copies share the parsed form.
/// Evaluation is const, deterministic and safe from several threads at once.
class Expression {
 public:
  Expression() : Expression(0.0) {}
  explicit Expression(double constant);
  /// Parses a formula. `allowed` lists which of x, y, z, t it may use. Throws FormulaError.
  static Expression parse(const std::string& formula, const Variables& variables,
                          const std::string& allowed = "xyzt");

  /// The value at a point (m) and a time (s); may be non-finite, e.g. for 1/x at 0.
  double operator()(const Vec3& at, double t) const;
  bool is_constant() const { return !program_; }
  bool depends_on_time() const;
  bool depends_on_space() const;
  /// The formula as written, or the shortest text of the number.
  const std::string& text() const { return text_; }

 private:
  class Program;
  double constant_ = 0.0;
  std::string text_;
  std::shared_ptr<const Program> program_;
};

/// The value of a formula of deck variables alone. Throws FormulaError (also when not finite).
double evaluate_constant(const std::string& formula, const Variables& variables);

/// Names that every deck can use without defining them: its `dimension` and its `resolution`.
bool is_given_variable(const std::string& name);

/// Whether a deck variable may bear this name; the reason otherwise.
std::string why_no_variable(const std::string& name);

}  // namespace sphgeo
