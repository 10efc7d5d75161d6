#pragma once
// Grids of heights from files: numbers alone, points, or a grid of a map.

#include <optional>
#include <string>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// Heights on a regular grid, as a file gives them.
struct TerrainGrid {
  int nx = 0, ny = 0;
  std::vector<double> heights;  ///< row by row, rows along x from small to large y, m; NaN: a hole
  bool placed = false;          ///< whether the file says where the heights are
  double x = 0, y = 0;          ///< of the first height, m
  double dx = 0, dy = 0;        ///< distances of the heights, m
  double slack = 0;             ///< by which rounding in the file leaves them open, m
};

/// Reads heights from
///   - an ESRI ASCII grid: a header of ncols, nrows, xllcorner or xllcenter, yllcorner or
///     yllcenter, cellsize and NODATA_value, then rows from north to south (format "esri");
///   - a table of points with the columns x, y and z, in any order, that lie on a grid ("points");
///   - a table of numbers alone, each row along x, row after row along y ("grid").
/// Format "auto" tells them apart by their contents. A height of `no_data` is a hole; without it,
/// what the header says, and -9999, -32768 and 3.4e38 of either sign. Throws IoError, or TableError
/// with file and line.
TerrainGrid read_terrain(const std::string& path, const std::string& format,
                         std::optional<double> no_data);

/// Fills holes by the smooth surface (Laplace's equation) through the heights around them; at the
/// edge of the grid the surface ends level. Returns how many there were. Throws std::logic_error
/// when there is no height at all.
Index fill_holes(TerrainGrid& grid);

}  // namespace sphgeo
