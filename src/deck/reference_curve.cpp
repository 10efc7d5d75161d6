#include "deck/reference_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"
#include "deck/table_columns.h"

namespace sphgeo {
namespace {

// Factors of the deck on a column, or on what the column is compared with.
struct DeckScale {
  const char* key;
  double value;
  bool given;
  bool any_dimension;  // whether it may give the column another dimension than that of the probe
};

// The numbers of a column in the unit of the probe. Where the deck scales, its factor may be the
// one of the unit: then the numbers stay as they are; a unit and another factor contradict.
std::vector<double> converted(const CsvTable& table, const std::string& name,
                              std::optional<std::string_view> wanted, const DeckScale& scale) {
  std::vector<double> values = table.numbers(name);
  const std::optional<UnitText> from = heading_unit(table, name);
  if (!from) return values;
  const std::string& heading = table.heading(name);
  const bool plain = from->dimension.same_dimension(unit::none);
  // A unit of the program that no deck can write has no dimension to check.
  const std::optional<UnitText> to =
      wanted ? parse_unit(wanted->empty() ? "1" : *wanted) : std::optional<UnitText>();
  if (to && !from->dimension.same_dimension(to->dimension) &&
      !(scale.given && (plain || scale.any_dimension)))
    throw TableError(fmt::format(
        "{}: column '{}': '{}' is not {}{}", table.header_place(), heading,
        split_heading(heading).unit, dimension_words(to->dimension),
        scale.given ? fmt::format("; take it out of the heading if {} makes it one", scale.key)
                    : ""));
  UnitText unit = *from;
  if (to) {
    unit.factor *= to->divisor;
    unit.divisor *= to->factor;
  }
  const double factor = unit.factor / unit.divisor;
  if (!scale.given || plain) return in_si(table, name, std::move(values), unit);
  if (factor != 1 && !(std::abs(scale.value / factor - 1) < 1e-9))
    throw TableError(
        fmt::format("{}: column '{}': by its unit the numbers are multiplied by {}, and the deck "
                    "says {}: {}; leave one of them out",
                    table.header_place(), heading, exact(factor), scale.key, exact(scale.value)));
  return values;
}

// Whether points are left to compare with, and whether the norm can divide by them.
void check_usable(const ReferenceCurve& curve, const Expect& claim) {
  const std::string& path = claim.reference_csv->path;
  double first = INFINITY, last = -INFINITY, low = INFINITY, high = -INFINITY;
  for (std::size_t k = 0; k < curve.x.size(); ++k) {
    const double x = curve.x[k], y = curve.y[k];
    if (std::isnan(x) || std::isnan(y)) continue;
    first = std::min(first, x);
    last = std::max(last, x);
    if ((claim.from && x < *claim.from) || (claim.to && x > *claim.to)) continue;
    low = std::min(low, y);
    high = std::max(high, y);
  }
  if (first > last) throw TableError(path + ": no row has both a time and a value");
  if (low > high)
    throw TableError(
        fmt::format("{}: no row lies between 'from' and 'to': the curve reaches from "
                    "t = {} to {} s",
                    path, exact(first), exact(last)));
  if (claim.norm == "relative_l2" ? low == 0 && high == 0 : low == high)
    throw TableError(
        fmt::format("{}: all values of the curve are {}, and norm: {} divides by their {}{}", path,
                    exact(low), claim.norm, claim.norm == "relative_l2" ? "mean square" : "range",
                    low == 0 ? "" : "; say norm: relative_l2"));
}

// The product, or an error when it is too large.
void multiply(std::vector<double>& values, double by, double shift, const CsvTable& table,
              const char* key) {
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] = values[row] * by + shift;
    if (std::isinf(values[row]))
      throw TableError(fmt::format("{}: with {} the number is too large", table.place(row), key));
  }
}

}  // namespace

ReferenceCurve read_reference(const Expect& claim, std::optional<std::string_view> unit) {
  const CsvTable table = read_csv_table(claim.reference_csv->path);
  table.check_headings();
  if (table.names().size() < 2 && !(claim.x && claim.y))
    throw TableError(table.path() + ": a curve needs two columns, and the table has one");
  const DeckScale of_x{"x_scale", claim.x_scale, claim.x_scale != 1, false};
  const DeckScale of_y{claim.scale != 1 ? "scale" : "y_scale", claim.scale * claim.y_scale,
                       claim.scale != 1 || claim.y_scale != 1, claim.scale != 1};
  ReferenceCurve curve{converted(table, claim.x.value_or(table.names().front()),
                                 claim.reduce == "profile" ? "m" : "s", of_x),
                       converted(table, claim.y ? *claim.y : table.names()[1], unit, of_y)};
  multiply(curve.x, claim.x_scale, claim.x_shift, table, "x_scale");
  multiply(curve.y, claim.y_scale, 0, table, "y_scale");
  check_usable(curve, claim);
  return curve;
}

}  // namespace sphgeo
