#pragma once
// Water in the pores of soil at t = 0: which bodies, how many particles, where (section 3.3).

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostic.h"
#include "core/state_file.h"
#include "geometry/relaxation.h"
#include "scene/water_target.h"

namespace sphgeo {

/// Bodies of water that are filled together: those that overlap soil, and those that touch them.
struct PoreBodies {
  std::vector<std::size_t> bodies;     ///< of the deck, ascending
  std::shared_ptr<const Shape> water;  ///< all of them
};

/// Nothing when no water overlaps soil, or when numerics.pore_water asks for particles that stand
/// on a lattice in pores, too.
std::optional<PoreBodies> pore_bodies(const Model& model);

/// The particles of these bodies.
struct PoreWater {
  std::vector<std::size_t> bodies;           ///< of the deck, ascending
  std::vector<std::vector<Vec3>> particles;  ///< of each body, m
  double volume = 0;                    ///< of water in the pores and in the clear, m3 (m2 in 2D)
  Index accepted = 0;                   ///< particles in all
  Index moved = 0;                      ///< of them, those that were free to move
  std::vector<Vec3> start;              ///< before the first step, in the order of the particles
  std::vector<double> start_density;    ///< number density there
  std::vector<double> water_fraction;   ///< at the particles, phi
  std::vector<double> number_density;   ///< at the particles; 1 is the target
  std::vector<RelaxationStep> history;  ///< empty when nothing was free to move
  double water_density_spread = 0;
  Index interior = 0;
  double seconds = 0;  ///< wall time
  bool from_file = false;

  /// Particles too many (negative: too few) for the volume of water.
  double mass_error(double particle_volume) const {
    return static_cast<double>(accepted) - volume / particle_volume;
  }
  /// The particles of a body of the deck; nullptr when it is not among `bodies`.
  const std::vector<Vec3>* of_body(std::size_t body) const;
};

/// How thorough to be.
enum class Relaxing {
  as_deck,  ///< take the file that the deck names, or relax
  anew,     ///< relax whatever the deck names
  draft  ///< as_deck, but a scene that would take long stays as it was accepted: only the number is
         ///< right
};

/// Fills the pore bodies of a deck. Nothing when it has none, or when what is wrong stands in
/// `found`: a body that cannot be filled (E113), pores without room (E131), a file that is damaged
/// or was made for something else (E132).
std::optional<PoreWater> pore_water(const Model& model, Diagnostics& found,
                                    Relaxing how = Relaxing::as_deck);

/// Expected number of particles over that of a scene without soil, on a coarse grid; 1 without pore
/// bodies. For each body of the deck.
std::vector<double> expected_shares(const Model& model);

/// All that the particles depend on, as YAML: method, dimension, resolution, how to relax, water,
/// soil.
std::string depends_on(const Model& model, const PoreBodies& pores);

/// What a stored result is called in its last line and in errors.
StateFileKind relaxed_kind();

/// Puts a result with what it depends on, and takes it back. take() throws IoError when something
/// is missing.
void put(const PoreWater& water, const std::string& depends, StateSink& out);
PoreWater take(const StateSource& in, const PoreBodies& pores);

}  // namespace sphgeo
