#pragma once
// Wall particles in the concave corner of two walls.

#include <vector>

#include "scene/join_walls.h"

namespace sphgeo {

/// Marks the particles in concave corners, as below the foot of a side wall: those that have the
/// surfaces of two walls, which enclose less than 120 degrees, in front of them. All walls at rest
/// count as one, every moving one separately; spacing dp and reach of the kernel in m.
template <int Dim>
void mark_corners(std::vector<WallPart>& parts, double dp, double reach);

extern template void mark_corners<2>(std::vector<WallPart>&, double, double);
extern template void mark_corners<3>(std::vector<WallPart>&, double, double);

}  // namespace sphgeo
