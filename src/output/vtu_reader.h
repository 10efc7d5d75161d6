#pragma once
// Reads the frames that write_vtu and write_vtu_mesh have written.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/types.h"

namespace sphgeo {

/// One array of a frame, as real numbers: exact for all types but integers beyond 2^53.
struct VtuColumn {
  std::string name;
  std::string unit;  ///< SI; empty: none
  int components = 1;
  std::vector<double> values;  ///< the components of each point (or cell) one after another

  std::size_t tuples() const { return values.size() / static_cast<std::size_t>(components); }
  /// A scalar itself, of more components the root of the sum of their squares.
  double magnitude(std::size_t tuple) const;
};

/// What a frame holds.
struct VtuFrame {
  std::optional<double> time;  ///< s
  std::vector<Vec3> points;    ///< m
  std::vector<VtuColumn> point_fields, cell_fields;
  int corners_per_cell = 1;    ///< 1: particles, 2: lines, 3: triangles
  std::vector<Index> corners;  ///< point numbers, cell by cell; empty for particles

  /// The point field of that name; nullptr when there is none.
  const VtuColumn* find(std::string_view name) const;
};

struct VtuReading {
  /// Which fields to keep; empty: all. Positions, time and corners are always read.
  std::function<bool(const std::string& name)> wanted;
  /// A larger file, or one that would take more memory, is refused.
  std::uint64_t most_bytes = std::uint64_t{8} << 30;
};

/// Reads a .vtu file of sphgeo. Throws IoError with the path when it cannot be read, was written by
/// another program (by another form of the format, that is), or is damaged: its sizes are verified.
VtuFrame read_vtu(const std::string& path, const VtuReading& reading = {});

/// The names, units and components of the point fields, without their values. Throws as read_vtu.
std::vector<VtuColumn> vtu_fields(const std::string& path);

}  // namespace sphgeo
