#pragma once
// The surfaces of a deck's boundaries, as frames and pictures show them.

#include <cstdint>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// Lines (2D) or triangles (3D).
struct BoundaryMesh {
  std::vector<Vec3> points;              ///< m
  std::vector<Index> corners;            ///< point numbers, 2 or 3 a cell
  std::vector<std::int32_t> part;        ///< of each cell: which boundary of the deck it belongs to
  std::vector<std::int32_t> point_part;  ///< of each point
};

/// The surfaces of all walls that have one, where the deck places them.
BoundaryMesh boundary_mesh(const Model& model);

/// Their points (m) at a time (s).
std::vector<Vec3> points_at(const BoundaryMesh& mesh, const Model& model, double time);

/// Whether any wall moves, so that its surface depends on time.
bool boundaries_move(const Model& model);

}  // namespace sphgeo
