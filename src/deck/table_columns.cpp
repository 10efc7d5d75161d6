#include "deck/table_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/text.h"

namespace sphgeo {

std::optional<UnitText> heading_unit(const CsvTable& table, std::string_view name) {
  const std::string& heading = table.heading(name);
  const std::string text(split_heading(heading).unit);
  if (text.empty()) return {};
  const std::optional<UnitText> unit = parse_unit(text == "-" ? "1" : text);
  if (!unit) {
    const std::string near = nearest_unit(text);
    throw TableError(fmt::format("{}: column '{}': there is no unit '{}'{}", table.header_place(),
                                 heading, text,
                                 near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  return unit;
}

UnitText column_unit(const CsvTable& table, std::string_view name, const Unit& wanted) {
  const std::optional<UnitText> unit = heading_unit(table, name);
  if (!unit) return {1.0, 1.0, wanted};
  if (!unit->dimension.same_dimension(wanted))
    throw TableError(fmt::format("{}: column '{}': '{}' is not {}", table.header_place(),
                                 table.heading(name), split_heading(table.heading(name)).unit,
                                 dimension_words(wanted)));
  return *unit;
}

std::vector<double> in_si(const CsvTable& table, std::string_view name, std::vector<double> values,
                          const UnitText& unit) {
  for (std::size_t row = 0; row < values.size(); ++row) {
    values[row] = values[row] * unit.factor / unit.divisor;
    if (std::isinf(values[row]))
      throw TableError(fmt::format("{}: column '{}': '{}' is too large in this unit",
                                   table.place(row), table.heading(name), table.text(name)[row]));
  }
  return values;
}

std::vector<double> si_column(const CsvTable& table, std::string_view name, const Unit& wanted) {
  const UnitText unit = column_unit(table, name, wanted);
  return in_si(table, name, table.all_numbers(name), unit);
}

void check_columns(const CsvTable& table, const std::vector<std::string>& known) {
  if (!table.named())
    throw TableError(table.path() + ": the table has no row of column names; expected " +
                     in_words(known, "or"));
  table.check_headings();
  for (const std::string& heading : table.names()) {
    const std::string name(split_heading(heading).name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw TableError(fmt::format("{}: there is no column '{}' here; {}", table.header_place(),
                                   name, suggestion(name, known, "columns")));
  }
}

}  // namespace sphgeo
