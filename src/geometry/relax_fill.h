#pragma once
// Body-fitted filling of curved shapes: level-set-guided particle relaxation (section 3.3, Eqs.
// 83-86, with one constant target volume; refs. 40 and 41 of the paper).

#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

struct RelaxFillOptions {
  int steps = 200;          ///< at most this many relaxation steps
  double tolerance = 5e-4;  ///< stop when the mean movement per step falls below this share of dp
  double h_factor = 1.3;    ///< h / dp of the Wendland C2 kernel, support 2 h
  Aabb clip;                ///< as for fill_lattice; empty: none
};

/// One row per relaxation step.
struct RelaxFillStep {
  double mean_move;       ///< share of dp
  double largest_move;    ///< share of dp
  double density_spread;  ///< standard deviation of the number density over its mean
};

struct RelaxFillResult {
  std::vector<Vec3> positions;  ///< in the order of the lattice they came from
  std::vector<RelaxFillStep> history;
  bool converged = false;
  double particle_volume = 0.0;  ///< volume (area in 2D) of the shape over the number of particles
  double density_spread = 0.0;   ///< standard deviation of the number density over its mean
  double density_low = 0.0;      ///< smallest and largest number density times particle_volume;
  double density_high = 0.0;     ///< 1 is even
  double surface_offset = 0.0;   ///< rms of (depth - dp/2) / dp over the outermost particles
};

/// Starts from the lattice fill and moves the particles under a constant background pressure until
/// they are evenly spaced and their outermost layer lies dp/2 below the surface. Gather only and in
/// blocks of fixed size: the same bits for any number of threads. Throws as fill_lattice.
RelaxFillResult relax_fill(const Shape& shape, double dp, int dim,
                           const RelaxFillOptions& options = {});

/// The same from given positions, which need not lie inside.
RelaxFillResult relax_positions(const Shape& shape, std::vector<Vec3> start, double dp, int dim,
                                const RelaxFillOptions& options = {});

}  // namespace sphgeo
