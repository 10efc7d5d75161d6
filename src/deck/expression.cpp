#include "deck/expression.h"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <thread>

#include "core/error.h"
#include "core/text.h"
#include "deck/unit.h"

namespace sphgeo {

namespace {

const std::vector<std::string>& function_names() {
  static const std::vector<std::string> names{
      "min",  "max",   "abs",   "sqrt", "sin",  "cos",   "tan",   "asin",      "acos",
      "atan", "atan2", "exp",   "log",  "ln",   "log10", "pow",   "tanh",      "sinh",
      "cosh", "sign",  "floor", "ceil", "step", "ramp",  "clamp", "smoothstep"};
  return names;
}

double step(double a) { return a < 0.0 ? 0.0 : 1.0; }
double ramp(double a) { return a < 0.0 ? 0.0 : a; }
double clamp(double a, double low, double high) { return std::min(std::max(a, low), high); }
double smoothstep(double from, double to, double a) {
  const double s = clamp((a - from) / (to - from), 0.0, 1.0);
  return s * s * (3.0 - 2.0 * s);
}
double power(double a, double b) { return std::pow(a, b); }
double floor_of(double a) { return std::floor(a); }
double ceil_of(double a) { return std::ceil(a); }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

constexpr std::string_view coordinates = "xyzt";

/// The values a compiled formula reads: x, y, z, t.
using Inputs = std::array<double, 4>;

void define(mu::Parser& parser, const Variables& variables, Inputs& inputs) {
  parser.ClearConst();
  parser.ClearFun();
  parser.ClearInfixOprt();
  parser.DefineInfixOprt("-", [](double a) { return -a; });
  parser.DefineInfixOprt("+", [](double a) { return a; });
  parser.DefineInfixOprt("!", [](double a) { return a == 0.0 ? 1.0 : 0.0; });
  parser.DefineInfixOprtChars("-+!");
  using One = double (*)(double);
  using Two = double (*)(double, double);
  parser.DefineFun("min", [](const double* a, int n) { return *std::min_element(a, a + n); });
  parser.DefineFun("max", [](const double* a, int n) { return *std::max_element(a, a + n); });
  const std::pair<const char*, One> unary[] = {
      {"abs", std::fabs},  {"sqrt", std::sqrt}, {"sin", std::sin},   {"cos", std::cos},
      {"tan", std::tan},   {"asin", std::asin}, {"acos", std::acos}, {"atan", std::atan},
      {"exp", std::exp},   {"log", std::log},   {"ln", std::log},    {"log10", std::log10},
      {"tanh", std::tanh}, {"sinh", std::sinh}, {"cosh", std::cosh}, {"floor", floor_of},
      {"ceil", ceil_of},   {"step", step},      {"ramp", ramp}};
  for (const auto& [name, f] : unary) parser.DefineFun(name, f);
  parser.DefineFun("sign", [](double a) { return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : 0.0; });
  parser.DefineFun("atan2", static_cast<Two>(std::atan2));
  parser.DefineFun("pow", power);
  parser.DefineFun("clamp", clamp);
  parser.DefineFun("smoothstep", smoothstep);
  parser.DefineConst("pi", std::numbers::pi);
  for (const auto& [name, value] : variables.values) parser.DefineConst(name, value);
  for (std::size_t k = 0; k < coordinates.size(); ++k) {
    parser.DefineVar(std::string(1, coordinates[k]), &inputs[k]);
  }
}

/// A name in a formula and where it starts.
struct Word {
  std::string text;
  int offset;
};

/// Names of a formula; refuses what muparser would accept but a deck may not contain.
std::vector<Word> words_of(const std::string& f) {
  constexpr std::size_t longest = 2000;
  if (f.size() > longest) {
    throw FormulaError("the formula is too long", fmt::format("at most {} characters", longest), 0);
  }
  std::vector<Word> words;
  int depth = 0;
  std::vector<bool> call;  // whether each open parenthesis belongs to a function
  for (std::size_t k = 0; k < f.size();) {
    const char c = f[k];
    const int at = static_cast<int>(k);
    if (is_letter(c)) {
      const std::size_t from = k;
      while (k < f.size() && (is_letter(f[k]) || is_digit(f[k]))) ++k;
      words.push_back({f.substr(from, k - from), at});
      continue;
    }
    if (is_digit(c) || c == '.') {
      const std::size_t from = k;
      while (k < f.size() && (is_digit(f[k]) || f[k] == '.')) ++k;
      // An exponent belongs to the number only when digits follow: 2e3, but not 2exp(x).
      if (k < f.size() && (f[k] == 'e' || f[k] == 'E')) {
        std::size_t end = k + 1;
        if (end < f.size() && (f[end] == '+' || f[end] == '-')) ++end;
        if (end < f.size() && is_digit(f[end])) {
          while (end < f.size() && is_digit(f[end])) ++end;
          k = end;
        }
      }
      const NumberText n = parse_number(f.substr(from, k - from));
      if (n.status != NumberText::Status::number) {
        throw FormulaError(fmt::format("'{}' {}", f.substr(from, k - from),
                                       n.why.empty() ? "is not a number" : n.why),
                           {}, at);
      }
      if (k < f.size() && is_letter(f[k])) {
        throw FormulaError(
            fmt::format("an operator is missing after '{}'", f.substr(from, k - from)),
            "write 2*L, not 2L", static_cast<int>(k));
      }
      continue;
    }
    if (c == '(') {
      ++depth;
      std::size_t before = k;
      while (before > 0 && f[before - 1] == ' ') --before;
      call.push_back(before > 0 && (is_letter(f[before - 1]) || is_digit(f[before - 1])));
    }
    if (c == ')') {
      if (--depth < 0) throw FormulaError("a ')' has no '('", {}, at);
      call.pop_back();
    }
    // muparser takes "1, 2" for 2 and "x = 3" for an assignment.
    if (c == ',' && (call.empty() || !call.back())) {
      throw FormulaError("a ',' stands outside a function", "decimals are written with a point",
                         at);
    }
    if (c == '=') {
      const char before = k > 0 ? f[k - 1] : ' ';
      const bool doubled = k + 1 < f.size() && f[k + 1] == '=';
      if (!doubled && before != '=' && before != '<' && before != '>' && before != '!') {
        throw FormulaError("'=' is an assignment, which formulas do not have",
                           "compare with ==", at);
      }
    }
    if (std::string_view("+-*/^()<>=!&|?:, \t").find(c) == std::string_view::npos) {
      throw FormulaError(fmt::format("'{}' is not allowed in a formula", c), {}, at);
    }
    ++k;
  }
  if (depth > 0) throw FormulaError("a '(' is not closed", {}, static_cast<int>(f.size()) - 1);
  constexpr int deepest = 100;
  if (std::count(f.begin(), f.end(), '(') > deepest) {
    throw FormulaError("the formula has too many parentheses", {}, 0);
  }
  return words;
}

/// Checks every name; returns which of x, y, z, t are used.
std::string check_names(const std::vector<Word>& words, const Variables& variables,
                        const std::string& allowed) {
  std::string used;
  for (const Word& w : words) {
    const bool coordinate =
        w.text.size() == 1 && coordinates.find(w.text) != std::string_view::npos;
    if (coordinate && allowed.find(w.text) != std::string::npos) {
      if (used.find(w.text) == std::string::npos) used += w.text;
      continue;
    }
    if (const double* value = variables.find(w.text)) {
      if (std::isnan(*value)) {
        throw FormulaError(fmt::format("variable '{}' has no value", w.text), {}, w.offset, w.text);
      }
      continue;
    }
    const std::vector<std::string>& functions = function_names();
    if (w.text == "pi" ||
        std::find(functions.begin(), functions.end(), w.text) != functions.end()) {
      continue;
    }
    if (coordinate) {
      const std::string names =
          allowed.empty()
              ? "only variables of the deck are"
              : fmt::format("only variables of the deck and {} are",
                            fmt::join(std::vector<char>(allowed.begin(), allowed.end()), ", "));
      throw FormulaError(fmt::format("'{}' is not available here", w.text), names, w.offset,
                         w.text);
    }
    std::vector<std::string> known;
    for (const auto& v : variables.values) known.push_back(v.first);
    for (const char c : allowed) known.emplace_back(1, c);
    known.emplace_back("pi");
    std::string help = nearest_name(w.text, known);
    if (help.empty()) help = nearest_name(w.text, functions);
    help = help.empty() ? "variables are defined under 'variables'"
                        : fmt::format("did you mean '{}'?", help);
    throw FormulaError(fmt::format("unknown name '{}' in the formula", w.text), help, w.offset,
                       w.text);
  }
  return used;
}

std::string plain_message(const mu::Parser::exception_type& e) {
  std::string message = lower_case(e.GetMsg().substr(0, 1)) + e.GetMsg().substr(1);
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  return "cannot read the formula: " + message;
}

}  // namespace

/// A compiled formula. A muparser object writes to itself while it evaluates, so each evaluation
/// borrows one of a few copies; which copy cannot change the result.
class Expression::Program {
 public:
  Program(std::string formula, Variables variables, std::string used)
      : formula_(std::move(formula)), variables_(std::move(variables)), used_(std::move(used)) {}

  double operator()(const Inputs& inputs) const {
    std::size_t k = std::hash<std::thread::id>{}(std::this_thread::get_id()) % copies_.size();
    for (int tries = 1; copies_[k].busy.test_and_set(std::memory_order_acquire); ++tries) {
      k = (k + 1) % copies_.size();
      if (tries % static_cast<int>(copies_.size()) == 0) std::this_thread::yield();
    }
    Copy& copy = copies_[k];
    const Release release{copy.busy};
    copy.inputs = inputs;
    try {
      if (!copy.parser) {
        copy.parser = std::make_unique<mu::Parser>();
        define(*copy.parser, variables_, copy.inputs);
        copy.parser->SetExpr(formula_);
      }
      return copy.parser->Eval();
    } catch (const mu::Parser::exception_type& e) {
      throw FormulaError(plain_message(e), {}, std::max(0, static_cast<int>(e.GetPos())));
    }
  }

  const std::string& used() const { return used_; }

 private:
  struct Copy {
    std::atomic_flag busy = ATOMIC_FLAG_INIT;
    std::unique_ptr<mu::Parser> parser;
    Inputs inputs{};
  };
  struct Release {
    std::atomic_flag& flag;
    ~Release() { flag.clear(std::memory_order_release); }
  };

  std::string formula_;
  Variables variables_;
  std::string used_;
  mutable std::array<Copy, 16> copies_;
};

const double* Variables::find(const std::string& name) const {
  for (const auto& v : values) {
    if (v.first == name) return &v.second;
  }
  return nullptr;
}

Expression::Expression(double constant) : constant_(constant), text_(exact(constant)) {}

Expression Expression::parse(const std::string& formula, const Variables& variables,
                             const std::string& allowed) {
  if (trimmed(formula).empty()) throw FormulaError("the formula is empty", {}, 0);
  const std::vector<Word> words = words_of(formula);
  const std::string used = check_names(words, variables, allowed);
  // Only the variables that it uses: a deck may have thousands of variables and formulas.
  Variables named;
  for (const Word& w : words)
    if (const double* value = variables.find(w.text);
        value != nullptr && named.find(w.text) == nullptr)
      named.values.emplace_back(w.text, *value);
  const auto program = std::make_shared<Program>(formula, std::move(named), used);
  const double value = (*program)({0.0, 0.0, 0.0, 0.0});  // finds what only muparser can see
  if (used.empty()) {
    if (!std::isfinite(value)) throw FormulaError("the formula has no finite value", {}, 0);
    // As for a plain number: near zero it has lost digits.
    if (value != 0.0 && !std::isnormal(value))
      throw FormulaError("the value of the formula is too small for a number in double precision",
                         {}, 0);
    return Expression(value);
  }
  Expression e;
  e.text_ = formula;
  e.program_ = program;
  return e;
}

double Expression::operator()(const Vec3& at, double t) const {
  return program_ ? (*program_)({at.x(), at.y(), at.z(), t}) : constant_;
}

bool Expression::depends_on_time() const {
  return program_ && program_->used().find('t') != std::string::npos;
}

bool Expression::depends_on_space() const {
  return program_ && program_->used().find_first_of("xyz") != std::string::npos;
}

double evaluate_constant(const std::string& formula, const Variables& variables) {
  return Expression::parse(formula, variables, "")(Vec3::Zero(), 0.0);
}

bool is_given_variable(const std::string& name) {
  return name == "dimension" || name == "resolution";
}

std::string why_no_variable(const std::string& name) {
  if (name.empty() || !is_letter(name[0]) ||
      !std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); })) {
    return "must be made of letters, digits and _, and not start with a digit";
  }
  if (name == "pi") return "is already the number pi";
  if (is_given_variable(name)) return "is already the " + name + " of the deck";
  if (name.size() == 1 && coordinates.find(name) != std::string_view::npos) {
    return "already stands for position or time in formulas";
  }
  const std::vector<std::string>& functions = function_names();
  if (std::find(functions.begin(), functions.end(), name) != functions.end()) {
    return "is already the name of a function";
  }
  return {};
}

}  // namespace sphgeo
