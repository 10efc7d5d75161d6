#pragma once
// Fills shapes with particles on a square or cubic lattice.

#include <optional>
#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

/// More particles than this in one body are reported as a mistake (such as millimetres given as
/// metres).
inline constexpr double largest_fill = 4e9;

/// Expected number of lattice points: the volume (area in 2D) of the shape within `clip`, estimated
/// on a coarse grid, over dp^dim. Infinite when neither bounds the shape.
double estimate_fill(const Shape& shape, double dp, int dim, const Aabb& clip);

/// The cell centres origin + (k + 1/2) dp inside the shape and inside `clip`, x fastest, z slowest;
/// y = 0 in 2D. The default origin is the lower corner of the shape's box (of `clip` where that is
/// unbounded), so that a box of whole multiples of dp is filled exactly. A point counts as inside
/// when its signed distance is below -1e-9 dp. Throws Error (usage) when the shape is unbounded
/// within `clip` or would take more than `largest_fill` points.
std::vector<Vec3> fill_lattice(const Shape& shape, double dp, int dim, const Aabb& clip = {},
                               std::optional<Vec3> origin = std::nullopt);

/// Points of a body and the volume (area in 2D) that each stands for.
struct FilledBox {
  std::vector<Vec3> at;
  double volume = 0;
  double stretch = 0;  ///< largest |spacing / dp - 1| along an axis
};

struct Box;

/// A lattice that fits a box of any size: the nearest whole number of rows along each axis, evenly
/// divided, so that all outer rows lie half a spacing below the faces and the volume is that of the
/// box. Of whole multiples of dp it is the lattice of fill_lattice, bit by bit. No points where a
/// side is shorter than half a spacing. Throws as fill_lattice.
FilledBox fill_box(const Box& box, double dp, int dim);

/// Volume (area in 2D) of the shape, the cells of fill_lattice's lattice cut by the surface: exact
/// for boxes, good to the square of the spacing for smooth shapes. Throws as fill_lattice.
double cut_volume(const Shape& shape, double dp, int dim);

enum class LayerSide { inside, outside };

/// Boundary layers: lattice points nearer than `thickness` (m) to the surface, inside or outside
/// the solid. The lattice starts at the lower corner of the shape's box, so the layers of a box are
/// aligned with its faces and its outer corners are filled. Throws as fill_lattice.
std::vector<Vec3> fill_layers(const Shape& shape, double dp, int dim, double thickness,
                              LayerSide side, const Aabb& clip = {});

/// Expected number of points of fill_layers, estimated as in estimate_fill. Infinite when nothing
/// bounds the shape.
double estimate_layers(const Shape& shape, double dp, int dim, double thickness, LayerSide side,
                       const Aabb& clip = {});

}  // namespace sphgeo
