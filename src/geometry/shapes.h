#pragma once
// The plain structs of the built-in shapes, for code and tests that make them without a deck. Each
// is declared to the deck and computed in its own .cpp file; a further shape may live in one file
// alone. Negative inside, positive outside, metres. `flat` marks a 2D scene (the x-z plane): y
// extents are ignored there and boxes have y = 0. The check rule of each schema sets it; call
// prepare() after filling a struct by hand.

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "core/direction.h"
#include "deck/interfaces.h"
#include "deck/schema.h"
#include "geometry/bvh.h"
#include "geometry/distance.h"
#include "geometry/triangle_mesh.h"

namespace sphgeo {

/// A shape with a flag for scenes in the x-z plane.
struct SceneShape : Shape {
  bool flat = false;

 protected:
  /// The box with its y range dropped in 2D.
  Aabb seen(Aabb b) const {
    if (flat) b.lo.y() = b.hi.y() = 0.0;
    return b;
  }
};

/// A box along the axes.
struct Box final : SceneShape {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  static Schema<Box> schema();
  double signed_distance(const Vec3& at) const override { return box_distance(at, min, max, flat); }
  bool along_axes() const override { return true; }
  Aabb box() const override { return seen({min, max}); }
};

/// A ball; a disc in 2D.
struct Sphere final : SceneShape {
  Vec3 center = Vec3::Zero();
  double radius = 0.0;
  static Schema<Sphere> schema();
  double signed_distance(const Vec3& at) const override { return (at - center).norm() - radius; }
  Aabb box() const override;
};

/// An ellipsoid along the axes; an ellipse in 2D.
struct Ellipsoid final : SceneShape {
  Vec3 center = Vec3::Zero();
  Vec3 semi_axes = Vec3::Zero();
  static Schema<Ellipsoid> schema();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
};

/// A cylinder with flat ends. In 2D: a disc when the ends coincide in the plane, else its section.
struct Cylinder final : SceneShape {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  double radius = 0.0;
  static Schema<Cylinder> schema();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
};

/// A cone or frustum with flat ends; in 2D its lengthwise section.
struct Cone final : SceneShape {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  double radius_from = 0.0;
  double radius_to = 0.0;
  static Schema<Cone> schema();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
};

/// All points within `radius` of a segment.
struct Capsule final : SceneShape {
  Vec3 from = Vec3::Zero();
  Vec3 to = Vec3::Zero();
  double radius = 0.0;
  static Schema<Capsule> schema();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
};

/// A polygon in the x-z plane; in 3D it extends along y between y_min and y_max, or without end.
struct Polygon : SceneShape {
  std::vector<Vec3> points;
  std::optional<double> y_min;
  std::optional<double> y_max;
  static Schema<Polygon> schema();
  void prepare();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  bool along_axes() const override;
  const std::vector<Vec2>& corners() const { return corners_; }  ///< (x, z)

 private:
  std::vector<Vec2> corners_;
};

/// All points below a plane.
struct HalfSpace final : SceneShape {
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< outward, any length
  static Schema<HalfSpace> schema();
  void prepare() { unit_ = direction_of(normal); }
  double signed_distance(const Vec3& at) const override { return (at - point).dot(unit_); }
  bool along_axes() const override { return unit_.cwiseAbs().maxCoeff() > 1 - 1e-12; }
  Aabb box() const override;

 private:
  Vec3 unit_ = Vec3::UnitZ();
};

struct TerrainGrid;

/// Solid below a bilinear surface through a grid of heights, within the grid's rectangle.
struct HeightField final : SceneShape {
  std::optional<FilePath> file;
  std::string format = "auto";    ///< of the file, see read_terrain
  std::optional<double> no_data;  ///< the height in the file that means there is none
  std::string holes = "refuse";   ///< or "fill"
  std::vector<double> heights;    ///< row by row, instead of a file
  int columns = 0;                ///< heights in a row (along x); 0: all of them
  Vec3 origin = Vec3::Zero();  ///< of the first height of the first row; added to a file's places
  Vec3 map_origin = Vec3::Zero();  ///< what of the file's coordinates becomes zero
  std::optional<double> spacing, spacing_y;
  double scale = 1.0;            ///< factor on the heights
  std::optional<double> bottom;  ///< underside, z; none: unbounded
  double section = 0.0;          ///< 2D: the y of the section
  static Schema<HeightField> schema();
  /// Reads the file and builds the search tree. Throws IoError or Error for unusable heights.
  void prepare();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
  /// Surface height at (x, y), the grid's edge value outside.
  double height(double x, double y) const;

 private:
  double surface(double x, double y) const;
  double node(int i, int j) const;
  double patch_distance_squared(const Vec3& p, std::int32_t cell,
                                double best) const;  // infinite when more than `best`

  void place(const TerrainGrid& grid, const std::string& where);

  std::vector<double> grid_;  // metres, row by row
  int nx_ = 0, ny_ = 0;
  double x0_ = 0, y0_ = 0;  // of the first height
  bool along_y_ = false;    // one line of heights along y: x and y are exchanged within
  Index filled_ = 0;        // holes
  Vec3 lo_ = Vec3::Zero(), hi_ = Vec3::Zero();
  double dx_ = 0.0, dy_ = 0.0;
  BoxTree tree_;
};

/// A closed triangle surface from an STL file; in 2D its section with the plane y = 0.
struct Stl final : SceneShape {
  FilePath file;
  double scale = 1.0;
  double rotate = 0.0;  ///< rad, about `axis`
  Vec3 axis = Vec3::UnitZ();
  Vec3 translate = Vec3::Zero();
  std::optional<double> weld_tolerance;  ///< m; none: 1e-6 of the size
  static Schema<Stl> schema();
  /// Reads, scales, rotates, moves, welds and examines the surface. Throws IoError.
  void prepare();
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
  const Triangles& triangles() const { return surface_.mesh(); }
  const MeshHealth& health() const { return health_; }
  /// Ends of the section's segments (x, z), two by two; 2D only.
  const std::vector<Vec2>& section() const { return section_; }

 private:
  SurfaceDistance surface_;
  MeshHealth health_;
  std::vector<std::string> remarks_;  // about the file
  std::vector<Vec2> section_;
  BoxTree section_tree_;
};

using ShapePtr = std::shared_ptr<const Shape>;

/// A shape whose cheap distance is only a lower bound of the true one (of the right sign).
struct BoundedShape : SceneShape {
  double bound(const Vec3& at) const override = 0;
  bool composed() const override { return true; }
};

/// Whether all these shapes have faces along the axes only.
inline bool all_along_axes(const std::vector<ShapePtr>& shapes) {
  return std::all_of(shapes.begin(), shapes.end(),
                     [](const ShapePtr& s) { return s->along_axes(); });
}

/// For a point whose bound is zero but for round-off: whether it lies on a seam within the solid
/// (where parts that touch cover each other's surface) rather than on the surface. Searches within
/// `reach` (m).
bool on_inner_seam(const Shape& shape, const Vec3& at, double reach, bool flat);

/// All points of any part. The distance is exact outside; inside it is searched (see refine.h).
struct Union final : BoundedShape {
  std::vector<ShapePtr> of;
  std::vector<Aabb> boxes;  ///< of the parts, to skip distant ones
  static Schema<Union> schema();
  bool along_axes() const override { return all_along_axes(of); }
  double bound(const Vec3& at) const override;
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
};

/// The common part of all parts. The distance is exact inside; outside it is searched.
struct Intersection final : BoundedShape {
  std::vector<ShapePtr> of;
  static Schema<Intersection> schema();
  bool along_axes() const override { return all_along_axes(of); }
  double bound(const Vec3& at) const override;
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
};

/// The first part without all the others. The distance is exact inside; outside it is searched.
struct Difference final : BoundedShape {
  std::vector<ShapePtr> of;
  std::vector<Aabb> boxes;  ///< as of Union
  static Schema<Difference> schema();
  bool along_axes() const override { return all_along_axes(of); }
  double bound(const Vec3& at) const override;
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
};

/// Everything outside a shape.
struct Complement final : BoundedShape {
  ShapePtr of;
  static Schema<Complement> schema();
  bool along_axes() const override { return of->along_axes(); }
  double bound(const Vec3& at) const override { return -of->bound(at); }
  double signed_distance(const Vec3& at) const override { return -of->signed_distance(at); }
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
};

/// A hollow body: all points within `thickness` of a surface, on one side or half on each.
struct Shell final : SceneShape {
  ShapePtr of;
  double thickness = 0.0;
  std::string side = "inside";  ///< inside | outside | centered
  static Schema<Shell> schema();
  bool along_axes() const override { return of->along_axes(); }
  double signed_distance(const Vec3& at) const override;
  Aabb box() const override;
  void inspect(CheckContext& context) const override;

 private:
  double offset() const;  // level of the mid-surface in the inner shape's distance
};

/// A shape scaled and turned about a point, then moved.
struct Transform final : BoundedShape {
  ShapePtr of;
  double scale = 1.0;
  double rotate = 0.0;         ///< rad, right-handed about `axis`
  Vec3 axis = -Vec3::UnitY();  ///< the default turns x towards z
  Vec3 about = Vec3::Zero();
  Vec3 translate = Vec3::Zero();
  static Schema<Transform> schema();
  void prepare();
  bool along_axes() const override;
  double bound(const Vec3& at) const override { return scale * of->bound(back(at)); }
  double signed_distance(const Vec3& at) const override {
    return scale * of->signed_distance(back(at));
  }
  Aabb box() const override;
  void inspect(CheckContext& context) const override;
  /// The point of the inner shape that is mapped to `at`, and the inverse.
  Vec3 back(const Vec3& at) const {
    return about + turn_.transpose() * (at - translate - about) / scale;
  }
  Vec3 forth(const Vec3& p) const { return about + translate + scale * (turn_ * (p - about)); }

 private:
  Mat3 turn_ = Mat3::Identity();
};

}  // namespace sphgeo
