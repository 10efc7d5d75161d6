#pragma once
// Outward normals and projection onto the surface of any shape, from its signed distance alone.

#include "deck/interfaces.h"

namespace sphgeo {

/// Outward unit normal at p, Eq. (80), by central differences over +-`step` (m). Across an edge it
/// is the mean of the faces that meet there; where the differences cancel (the middle of a body)
/// the step is widened, and only for a point without any direction is it +z. `dim` 2 leaves y out.
Vec3 outward_normal(const Shape& shape, const Vec3& p, double step, int dim);

/// The point on the level set `signed_distance = level` (m) reached from p along the normals; p
/// itself when the shape has no direction there. Exact to about 1e-6 step for a true distance.
Vec3 project_to_level(const Shape& shape, const Vec3& p, double level, double step, int dim);

}  // namespace sphgeo
