#pragma once
// Many bodies from one entry of the deck: copies with seeded random positions, sizes and rotations.

#include <memory>
#include <optional>
#include <vector>

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// The key `copies` of a body.
struct Copies {
  int count = 1;
  std::shared_ptr<const Shape> region;  ///< the copies lie inside
  std::vector<double> sizes{1, 1};      ///< smallest and largest factor on the shape's lengths
  Index seed = 1;
  std::optional<double> gap;  ///< smallest distance between copies, m; empty: 2 spacings
  bool turned = true;         ///< whether each is rotated at random
  static Schema<Copies> schema();
};

/// Replaces every body with `copies` by bodies NAME_1, NAME_2 ..., each with its own shape:
/// rotated, scaled and moved inside the region, the largest first, such that balls around them keep
/// the gap. A boulder's seed grows by one from copy to copy. `reading` must know variables,
/// dimension and resolution.
void expand_copies(Node& root, DeckReading& reading);

}  // namespace sphgeo
