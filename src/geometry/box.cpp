#include "geometry/scene_check.h"
#include "geometry/shapes.h"

namespace sphgeo {

namespace {
const Register<Shape, Box> registered_box{"box"};
}

Schema<Box> Box::schema() {
  Schema<Box> s("box", "A box with its edges along the axes; a rectangle in 2D.");
  s.required("min", &Box::min, unit::length, "The corner with the smallest coordinates.");
  s.required("max", &Box::max, unit::length, "The corner with the largest coordinates.");
  s.check([](Box& b, CheckContext& c) {
    set_scene(b, c);
    const char* names = "xyz";
    for (int k = 0; k < 3; ++k)
      if (!(b.flat && k == 1) && b.max[k] <= b.min[k])
        return c.error("max", std::string("max must be larger than min in ") + names[k],
                       "give min the smaller and max the larger value of each coordinate");
  });
  return s;
}

}  // namespace sphgeo
