#include "geometry/shapes.h"

namespace sphgeo {

double distance_bound(const Shape& shape, const Vec3& at) {
  const auto* bounded = dynamic_cast<const BoundedShape*>(&shape);
  return bounded ? bounded->bound(at) : shape.signed_distance(at);
}

}  // namespace sphgeo
