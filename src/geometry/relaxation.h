#pragma once
// Level-set-guided relaxation: moves particles within a shape to an even distribution of a
// prescribed number density (section 3.3, Eqs. 80 to 86).

#include <functional>
#include <vector>

#include "deck/interfaces.h"

namespace sphgeo {

/// What the particles are to become.
struct RelaxationTarget {
  /// phi(x) within (0, 1]: the share of space that they may take (Eq. 81). None: 1 everywhere.
  std::function<double(const Vec3&)> fraction;
  double smallest_fraction = 1;  ///< phi is never less
  double volume =
      0;  ///< of a particle where phi is 1 [m^dim]; 0: that of the shape over their number
};

struct RelaxationOptions {
  int steps = 100;  ///< at most this many
  double tolerance =
      0;  ///< stop when the mean movement of a step falls below this share of spacing
  double h_factor = 1.8;  ///< h over the target spacing of Eq. 82
  double run_h = 0;       ///< smoothing length of the run, for run_density_spread [m]; 0: none
};

/// One row of the convergence history: before the first step and after each.
struct RelaxationStep {
  double density_spread = 0;  ///< standard deviation of the number density over its mean
  double density_mean = 0;    ///< of the same particles; 1 is the target
  double density_low = 0;     ///< smallest and largest of them
  double density_high = 0;
  double mean_move = 0;  ///< of a step, over the target spacing
  double largest_move = 0;
};

/// Where particles start.
struct Seeds {
  std::vector<Vec3> at;    ///< m
  std::vector<char> free;  ///< whether each may move; empty: all
};

struct RelaxedPositions {
  std::vector<Vec3> at;                 ///< m, in the order of the seeds
  std::vector<double> fraction;         ///< phi there
  std::vector<double> number_density;   ///< sum_j W_ij V_j, 1 is the target
  std::vector<double> start_density;    ///< the same before the first step
  std::vector<RelaxationStep> history;  ///< empty when nothing is free to move
  double volume = 0;                    ///< of a particle where phi is 1 [m^dim]
  double run_density_spread =
      0;               ///< as density_spread, with the smoothing length of the run for all
  Index interior = 0;  ///< particles that density_spread looks at
};

/// Relaxes the seeds within `shape`. Number density of a particle: S_i = sum_j W(r_ij, h_i) V_j
/// with itself and with what the kernel misses beyond the surface (the background mesh), V_j =
/// V / phi(x_j) (Eq. 81) and h_i = h_factor dp phi(x_i)^(-1/dim). The displacement of a step
/// is that of Eqs. 84 and 85 with the pseudo time step of the acceleration criterion. On the way,
/// particles may come 0.02 dp nearer to the surface than the half spacing of Eq. 86, and more near
/// edges of small shapes; in the end none does. The history looks at free particles whose
/// kernel misses nothing beyond the surface, and at all free ones when there are none.
/// What is not free has phi = 1. The same bits for any number of threads.
RelaxedPositions relax(const Shape& shape, const RelaxationTarget& target, Seeds seeds, double dp,
                       int dim, const RelaxationOptions& options);

/// Body-fitted filling of a curved shape: the lattice of fill_lattice, relaxed to one volume for
/// all (refs. 40 and 41 of the paper). Throws as fill_lattice.
RelaxedPositions relax_fill(const Shape& shape, double dp, int dim);

}  // namespace sphgeo
