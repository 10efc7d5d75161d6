#pragma once
// Frames for ParaView: VTK unstructured grids (.vtu) with appended raw binary data.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/file_image.h"
#include "core/types.h"

namespace sphgeo {

/// One array of a frame. `data` holds the components of each particle one after another.
struct VtuField {
  std::string name;
  std::string unit;  ///< SI; stored as the array's UNITS_LABEL, "" or "1" = none
  int components = 1;
  std::variant<std::span<const double>, std::span<const float>, std::span<const std::int32_t>,
               std::span<const std::int64_t>, std::span<const std::uint64_t>,
               std::span<const std::uint8_t>>
      data;
};

/// The positions of the points (m): in an array of Vec3, or computed one by one.
class VtuPoints {
 public:
  VtuPoints(std::span<const Vec3> points)  // NOLINT(google-explicit-constructor)
      : count_(static_cast<Index>(points.size())),
        at_([points](Index i) { return points[static_cast<std::size_t>(i)]; }) {}
  VtuPoints(const std::vector<Vec3>& points)  // NOLINT(google-explicit-constructor)
      : VtuPoints(std::span<const Vec3>(points)) {}
  VtuPoints(Index count, std::function<Vec3(Index)> at) : count_(count), at_(std::move(at)) {}

  Index count() const { return count_; }
  Vec3 operator()(Index i) const { return at_(i); }

 private:
  Index count_;
  std::function<Vec3(Index)> at_;
};

enum class VtuPrecision { float32, float64 };

struct VtuOptions {
  VtuPrecision precision = VtuPrecision::float32;  ///< of positions and of fields of double
  /// Deflate the integer arrays: they shrink to a fraction, while zlib hardly shrinks real numbers,
  /// which therefore stay as they are (stored blocks that VTK's zlib reader understands).
  bool compress = true;
  std::optional<double> time;  ///< s; stored as TimeValue
};

/// A file with one vertex cell per particle: without them ParaView's Threshold returns nothing.
/// Composed by all threads, whatever their number the same bytes. Throws std::invalid_argument when
/// a field has a wrong length.
FileImage vtu_image(const VtuPoints& points, const std::vector<VtuField>& fields,
                    const VtuOptions& options = {});

/// Writes it, whole or not at all. Throws IoError.
void write_vtu(const std::string& path, const VtuPoints& points,
               const std::vector<VtuField>& fields, const VtuOptions& options = {});

/// Bytes of the file that write_vtu would write. Real numbers of fields are not read; they
/// are only counted.
std::uint64_t vtu_bytes(const VtuPoints& points, const std::vector<VtuField>& fields,
                        const VtuOptions& options = {});

/// A surface: `corners` holds the point numbers of each cell, 2 (lines) or 3 (triangles) a cell.
/// Throws as vtu_image does, std::invalid_argument also for a corner that is not a point.
FileImage vtu_mesh_image(const VtuPoints& points, int corners_per_cell,
                         std::span<const Index> corners, const std::vector<VtuField>& point_fields,
                         const std::vector<VtuField>& cell_fields, const VtuOptions& options = {});

/// Writes it, whole or not at all. Throws IoError.
void write_vtu_mesh(const std::string& path, const VtuPoints& points, int corners_per_cell,
                    std::span<const Index> corners, const std::vector<VtuField>& point_fields,
                    const std::vector<VtuField>& cell_fields, const VtuOptions& options = {});

/// Bytes of the file that write_vtu_mesh would write.
std::uint64_t vtu_mesh_bytes(const VtuPoints& points, int corners_per_cell,
                             std::span<const Index> corners,
                             const std::vector<VtuField>& point_fields,
                             const std::vector<VtuField>& cell_fields,
                             const VtuOptions& options = {});

/// Text in which & < > " are written as XML wants them.
std::string xml_escaped(const std::string& text);

}  // namespace sphgeo
