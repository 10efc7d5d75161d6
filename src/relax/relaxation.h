#pragma once
// Moves water particles to an even distribution of a prescribed number density (section 3.3, Eqs.
// 80 to 86).

#include <functional>
#include <memory>
#include <vector>

#include "relax/water_target.h"

namespace sphgeo {

struct RelaxationOptions {
  int steps = 100;  ///< at most this many
  double tolerance =
      0;  ///< stop when the mean movement of a step falls below this share of the spacing
  double h_factor = 1.8;  ///< h over the target spacing of Eq. 82
  double water_h = 0;     ///< smoothing length of the water of the run, m, for water_density_spread
};

/// One row of the convergence history: before the first step and after each.
struct RelaxationStep {
  double density_spread =
      0;                    ///< standard deviation of the number density over its mean, see relax()
  double density_mean = 0;  ///< of the same particles; 1 is the target
  double density_low = 0;   ///< smallest and largest of them
  double density_high = 0;
  double mean_move = 0;  ///< of a step, over the target spacing
  double largest_move = 0;
};

/// Where particles start.
struct Seeds {
  std::vector<Vec3> at;    ///< m; neighbors in space should be near in the list, for speed alone
  std::vector<char> free;  ///< whether each may move
};

struct RelaxedPositions {
  std::vector<Vec3> at;                ///< m, in the order of the seeds
  std::vector<double> water_fraction;  ///< phi there
  std::vector<double> number_density;  ///< sum_j W_ij V_j, 1 is the target
  std::vector<double> start_density;   ///< the same before the first step
  std::vector<RelaxationStep> history;
  double water_density_spread =
      0;               ///< as density_spread, with the smoothing length of the run for all
  Index interior = 0;  ///< particles that density_spread looks at
};

/// Relaxes the seeds within `water`. Number density of a particle: S_i = sum_j W(r_ij, h_i) V_j
/// with itself and with what the kernel misses beyond the surface (the background mesh), V_j =
/// dp^Dim / phi(x_j) (Eq. 81) and h_i = h_factor dp phi(x_i)^(-1/Dim). The displacement of a step
/// is that of Eqs. 84 and 85 with the pseudo time step of the acceleration criterion.
/// density_spread looks at free particles deeper than the reach 2 h_i of their kernel below the
/// surface of the water, and at all free ones when there are none; jumps of the water fraction are
/// not left out. The same bits for any number of threads.
RelaxedPositions relax(const Shape& water, const WaterTarget& target, Seeds seeds, double dp,
                       int dim, const RelaxationOptions& options);

}  // namespace sphgeo
