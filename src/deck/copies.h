#pragma once
// Many bodies from one entry of the deck: copies of it at seeded random places, sizes and turns.

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
  std::vector<double> sizes{1, 1};      ///< least and largest factor on the shape's lengths
  Index seed = 1;
  std::optional<double> gap;  ///< least distance between copies, m; empty: 2 spacings
  bool turned = true;         ///< whether each is turned at random
  static Schema<Copies> schema();
};

/// Replaces every body with `copies` by bodies NAME_1, NAME_2 ..., each with a shape of its own:
/// turned, scaled and moved inside the region, the largest first, where balls around them keep the
/// gap. A boulder's seed grows by one from copy to copy. `reading` must know variables, dimension
/// and resolution.
void expand_copies(Node& root, DeckReading& reading);

}  // namespace sphgeo
