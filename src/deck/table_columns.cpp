#include "deck/table_columns.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"

namespace sphgeo {

UnitText column_unit(const CsvTable& table, std::string_view name, const Unit& wanted) {
  const std::string& heading = table.heading(name);
  const std::string text(split_heading(heading).unit);
  if (text.empty() || text == "-") return {1.0, 1.0, wanted};
  const std::optional<UnitText> unit = parse_unit(text);
  if (!unit) {
    const std::string near = nearest_unit(text);
    throw TableError(fmt::format("{}: column '{}': there is no unit '{}'{}", table.header_place(),
                                 heading, text,
                                 near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  if (!unit->dimension.same_dimension(wanted))
    throw TableError(fmt::format("{}: column '{}': '{}' is not {}", table.header_place(), heading,
                                 text, dimension_words(wanted)));
  return *unit;
}

std::vector<double> si_column(const CsvTable& table, std::string_view name, const Unit& wanted) {
  const UnitText unit = column_unit(table, name, wanted);
  std::vector<double> values = table.all_numbers(name);
  for (double& v : values) v = v * unit.factor / unit.divisor;
  return values;
}

void check_columns(const CsvTable& table, const std::vector<std::string>& known) {
  if (!table.named())
    throw TableError(table.path() + ": the table has no row of column names; expected " +
                     in_words(known, "or"));
  for (const std::string& heading : table.names()) {
    const std::string name(split_heading(heading).name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw TableError(fmt::format("{}: there is no column '{}' here; {}", table.header_place(),
                                   name, suggestion(name, known, "columns")));
  }
}

}  // namespace sphgeo
