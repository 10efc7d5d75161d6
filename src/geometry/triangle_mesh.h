#pragma once
// A closed triangle surface: its defects (open, non-manifold, flipped), the distance to it and
// whether a point lies inside.

#include <array>
#include <vector>

#include "core/types.h"
#include "geometry/bvh.h"

namespace sphgeo {

/// Corners and the triangles between them; the corners of a triangle run counter-clockwise when
/// seen from outside.
struct Triangles {
  std::vector<Vec3> points;
  std::vector<std::array<std::int32_t, 3>> faces;
};

/// What is wrong with a surface. All zero for a closed, consistently oriented one.
struct MeshHealth {
  Index open_edges = 0;          ///< edges with one face
  Index non_manifold_edges = 0;  ///< edges with more than two faces
  Index flipped_faces = 0;       ///< faces turned against the majority of their connected part
  Index degenerate_faces = 0;    ///< faces without area or with a repeated corner; dropped
  Index duplicate_faces = 0;     ///< faces that repeat another one; dropped
  bool inside_out = false;       ///< the whole surface encloses a negative volume
  Vec3 open_at = Vec3::Zero();   ///< the centre of one open edge, to locate it
};

/// Makes corners of nearer than `tolerance` (m) one corner and drops faces that collapse; returns
/// the number of dropped faces. Tolerance 0 joins equal corners only.
Index weld(Triangles& mesh, double tolerance);

/// Drops faces with the corners of an earlier one in the same order around; returns their number.
Index drop_duplicates(Triangles& mesh);

/// Examines the edges and turns flipped faces so that each connected part is consistent; a surface
/// that is inside out as a whole is turned as well.
MeshHealth repair_orientation(Triangles& mesh);

/// Enclosed volume, m3; negative when inside out.
double enclosed_volume(const Triangles& mesh);

/// Squared distance from p to the triangle a b c.
double triangle_distance_squared(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Nearest-point and inside queries on a surface. Inside is where the generalised winding number
/// exceeds one half, which also gives a sensible answer near small holes. Distant parts of the
/// tree enter the winding number as one dipole.
class SurfaceDistance {
 public:
  SurfaceDistance() = default;
  explicit SurfaceDistance(Triangles mesh);

  double signed_distance(const Vec3& p) const;
  double winding_number(const Vec3& p) const;
  /// Share of the faces, of up to some hundreds that are looked at, that lie inside of the solid:
  /// closed parts that overlap or contain each other.
  double inner_faces() const;
  const Triangles& mesh() const { return mesh_; }
  Aabb box() const { return box_; }

 private:
  struct Dipole {
    Vec3 area = Vec3::Zero();    // sum of face area vectors
    Vec3 centre = Vec3::Zero();  // area-weighted centre
    double radius = 0.0;         // reach of the node's faces around the centre
  };

  Triangles mesh_;
  BoxTree tree_;
  std::vector<Dipole> dipoles_;
  Aabb box_;
};

}  // namespace sphgeo
