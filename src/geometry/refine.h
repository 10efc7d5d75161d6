#pragma once
// Turns the lower bound that union, intersection and difference give on their inexact side into a
// distance: finds the nearest point of the real surface.

#include <functional>

#include "core/types.h"

namespace sphgeo {

/// `bound(q)` has the right sign and at most the true magnitude everywhere. Returns the distance of
/// p to the surface with the sign of `bound(p)`, `exact_sign` being the sign for which the bound is
/// known to be exact already. One foot point decides for most points, and then the result is exact;
/// behind seams (where parts cover each other's surface) rays in fixed directions find the surface
/// and are moved along it to the nearest point: within about 2 % there, and the bound itself when
/// no ray meets it.
double refined_distance(const std::function<double(const Vec3&)>& bound, const Vec3& p,
                        int exact_sign, bool flat);

}  // namespace sphgeo
