#pragma once
// Columns of a table as the deck means them: names that are known, numbers in SI units.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/csv_table.h"
#include "deck/unit.h"

namespace sphgeo {

/// The unit in the heading of a column, "x [mm]"; none where there is none. "-" is that of plain
/// numbers. Throws TableError with file and line when it is not known.
std::optional<UnitText> heading_unit(const CsvTable& table, std::string_view name);

/// What a number of a column means in SI units, by its heading: "x [mm]" is divided by 1000. As
/// `wanted` where the heading has no unit. Throws TableError with file and line when the unit is
/// not known or is of another dimension than `wanted`.
UnitText column_unit(const CsvTable& table, std::string_view name, const Unit& wanted);

/// The same numbers in SI units. Throws TableError with file and line when one is too large.
std::vector<double> in_si(const CsvTable& table, std::string_view name, std::vector<double> values,
                          const UnitText& unit);

/// The numbers of a column in SI units; every cell must hold a number. Throws TableError with file
/// and line.
std::vector<double> si_column(const CsvTable& table, std::string_view name, const Unit& wanted);

/// Throws TableError when the table has no row of column names, or a column that is none of these;
/// the message gives the nearest name.
void check_columns(const CsvTable& table, const std::vector<std::string>& known);

}  // namespace sphgeo
