#pragma once
// From the model to particles.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "boundaries/boundary.h"
#include "core/diagnostic.h"
#include "deck/model.h"
#include "scene/body_filling.h"
#include "scene/pore_water.h"
#include "sph/world.h"

namespace sphgeo {

/// How the speed of sound was found, for `check`.
struct SoundSpeed {
  double value;         ///< c0, m/s
  double max_speed;     ///< the expected largest speed that it is derived from, m/s
  std::string because;  ///< one sentence
};

/// The particles of a body, for `check`.
struct BodyCount {
  std::string name;
  Index particles;
  FillingChoice filling;
};

/// A world and the findings of building it.
template <int Dim>
struct Scene {
  const Model* model = nullptr;  ///< what it was built from
  std::unique_ptr<World<Dim>> world;
  std::vector<BodyCount> body_particles;                          ///< by body of the deck
  std::vector<std::pair<std::string, Index>> boundary_particles;  ///< by boundary of the deck
  SoundSpeed sound{0, 0, ""};
  std::optional<PoreWater> pore_water;  ///< how the water in soil was filled, if there is any
};

/// Whether the sets are filled, or only made: a checkpoint brings its own particles. A draft has
/// the right number of particles, but much water in soil is not relaxed.
enum class Filling { bodies_and_boundaries, draft, none };

/// Fills bodies, places boundaries, sets the initial state. Findings about the deck that need
/// particles go to `found`; the model must outlive the world.
template <int Dim>
Scene<Dim> build_scene(const Model& model, Diagnostics& found,
                       Filling filling = Filling::bodies_and_boundaries);

/// c0 of the water: from the deck, or ten times the largest expected speed (below Eq. 26).
SoundSpeed water_sound_speed(const Model& model, const Aabb& water, const Aabb& everything);

/// Thickness of walls, m.
double support_radius(const Model& model);

/// Spacing of the water kernel, m.
double water_smoothing_length(const Model& model);

/// Spacing of the soil kernel, m.
double soil_smoothing_length(const Model& model);

extern template Scene<2> build_scene<2>(const Model&, Diagnostics&, Filling);
extern template Scene<3> build_scene<3>(const Model&, Diagnostics&, Filling);

}  // namespace sphgeo
