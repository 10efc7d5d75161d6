#pragma once
// Where the kernel sum over particles falls to one half: their surface.

#include <algorithm>
#include <optional>

namespace sphgeo {

/// Height of the topmost surface on a vertical line [m]; empty when there is none. `filled` gives
/// the kernel sum of volumes at a height, `top` and `bottom` bound the particles near the line.
template <class Filled>
std::optional<double> surface_height(double top, double bottom, double spacing, Filled&& filled) {
  // From the highest particle of the neighborhood down to the first half-filled kernel.
  double above = 0;
  for (double z = top + 2 * spacing; z > bottom - spacing; z -= 0.25 * spacing) {
    const double here = filled(z);
    if (here >= 0.5) return z + 0.25 * spacing * (here - 0.5) / std::max(here - above, 1e-12);
    above = here;
  }
  return std::nullopt;
}

}  // namespace sphgeo
