#pragma once
// Reads a shape from the text that a deck would hold after `shape:`.

#include <stdexcept>
#include <string>

#include "deck/schema.h"
#include "deck/yaml_reader.h"
#include "geometry/shapes.h"

namespace sphgeo::geometry_test {

/// The shape and everything the deck reader and the shape itself had to say about it.
struct ReadShape {
  ShapePtr shape;
  Diagnostics found;
  std::string messages() const {
    std::string all;
    for (const Diagnostic& d : found.items()) all += d.path + ": " + d.message + "\n";
    return all;
  }
};

inline ReadShape read_shape(const std::string& yaml, int dimension, double resolution = 0.0) {
  ReadShape out;
  Places places;
  DeckReading reading(out.found, places);
  reading.dimension = dimension;
  reading.resolution = resolution;
  reading.folder = ".";
  const std::optional<Node> node = read_yaml(yaml, "deck", out.found);
  if (!node) return out;
  const Key key("shape", value_type<ShapePtr>(), unit::none, true, "", [](void* p) { return p; });
  if (!value_type<ShapePtr>().read(*node, key, "shape", reading, &out.shape)) return out;
  if (out.found.has_errors()) return out;
  for (const auto& rule : reading.rules) rule();
  if (out.found.has_errors()) return out;
  CheckContext context(out.found, places, "shape", dimension, resolution);
  out.shape->inspect(context);
  return out;
}

/// The same for a shape that must be sound.
inline ShapePtr shape_of(const std::string& yaml, int dimension) {
  ReadShape r = read_shape(yaml, dimension);
  if (!r.shape || r.found.has_errors()) throw std::runtime_error(yaml + "\n" + r.messages());
  return r.shape;
}

/// A fixed sequence of numbers in [0, 1).
class Hash {
 public:
  double next() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ z >> 27) * 0x94d049bb133111ebull;
    return static_cast<double>((z ^ z >> 31) >> 11) * 0x1p-53;
  }
  Vec3 in(const Aabb& box, int dim) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = box.lo[k] + next() * (box.hi[k] - box.lo[k]);
    if (dim == 2) p.y() = 0.0;
    return p;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace sphgeo::geometry_test
