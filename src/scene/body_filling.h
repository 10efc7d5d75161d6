#pragma once
// The particles of one body, and the choice between a lattice and a body-fitted filling.

#include <cstddef>
#include <string>
#include <vector>

#include "deck/model.h"

namespace sphgeo {

/// The particles of one body before they join their set.
struct BodyPoints {
  std::vector<Vec3> at;
  double volume;  ///< of one particle, m3 (m2 in 2D)
};

/// How a body is filled, for `check`.
struct FillingChoice {
  bool relaxed;         ///< body-fitted; otherwise on a lattice
  std::string because;  ///< half a sentence
};

/// What `filling` says; auto: relaxed for rigid solids with faces that are not along the axes. A
/// disc cut out of a lattice is a staircase: it rolls and rises as its stairs allow. Elastic solids
/// stay on a lattice: relaxed, those with acute corners or thinner than two spacings burst without
/// a load, as the gradient of Eq. 66 has too few neighbors there. Water and soil stand on the
/// lattice of the walls beside them.
FillingChoice filling_of(const Body& body, const Model& model);

/// Fills the shape of a body as filling_of() says, displaced by the deck's jitter; or with the
/// `given` positions of pore water. Shapes that are unbounded, too large or hold no particle go to
/// `found`.
BodyPoints fill_body(const Model& model, std::size_t body, Diagnostics& found,
                     const std::vector<Vec3>* given = nullptr);

}  // namespace sphgeo
