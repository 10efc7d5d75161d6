#pragma once
// Columns of a table as the deck means them: names that are known, numbers in SI units.

#include <string>
#include <string_view>
#include <vector>

#include "core/csv_table.h"
#include "deck/unit.h"

namespace sphgeo {

/// What a number of a column means in SI units, by its heading: "x [mm]" is divided by 1000. As
/// `wanted` where the heading has no unit, or "-". Throws TableError with file and line when the
/// unit is not known or is of another dimension than `wanted`.
UnitText column_unit(const CsvTable& table, std::string_view name, const Unit& wanted);

/// The numbers of a column in SI units; every cell must hold a number. Throws TableError with file
/// and line.
std::vector<double> si_column(const CsvTable& table, std::string_view name, const Unit& wanted);

/// Throws TableError when the table has no row of column names, or a column that is none of these;
/// the message gives the nearest name.
void check_columns(const CsvTable& table, const std::vector<std::string>& known);

}  // namespace sphgeo
