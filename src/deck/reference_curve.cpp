#include "deck/reference_curve.h"

#include "deck/table_columns.h"

namespace sphgeo {
namespace {

std::vector<double> converted(const CsvTable& table, const std::string& name,
                              std::optional<std::string_view> wanted, bool scaled) {
  std::vector<double> values = table.numbers(name);
  if (scaled || !wanted || split_heading(table.heading(name)).unit.empty()) return values;
  const std::optional<UnitText> to = parse_unit(wanted->empty() ? "1" : *wanted);
  if (!to) return values;  // a unit of the program that no deck can write
  const UnitText from = column_unit(table, name, to->dimension);
  for (double& v : values) v = v * from.factor / from.divisor * to->divisor / to->factor;
  return values;
}

}  // namespace

ReferenceCurve read_reference(const Expect& claim, std::optional<std::string_view> unit) {
  const CsvTable table = read_csv_table(claim.reference_csv->path);
  if (table.names().size() < 2 && !(claim.x && claim.y))
    throw TableError(table.path() + ": a curve needs two columns, and the table has one");
  ReferenceCurve curve{
      converted(table, claim.x.value_or(table.names().front()), "s", claim.x_scale != 1),
      converted(table, claim.y ? *claim.y : table.names()[1], unit,
                claim.y_scale != 1 || claim.scale != 1)};
  for (double& v : curve.x) v = v * claim.x_scale + claim.x_shift;
  for (double& v : curve.y) v *= claim.y_scale;
  return curve;
}

}  // namespace sphgeo
