#pragma once
// Kernel sums whose smoothing length is each target's own: number density and its gradient, as the
// relaxation of particles to a prescribed spacing needs them (Eq. 84).

#include <span>
#include <vector>

#include "sph/cell_grid.h"
#include "sph/neighbor_list.h"
#include "sph/records.h"

namespace sphgeo {

/// For some particles of a set, the targets, sums over all of them: sum_j W(r_ij, h_i) V_j with
/// j = i included, and sum_j grad_i W(r_ij, h_i) V_j. Targets of similar smoothing length share a
/// neighbor list. Lists reach farther than the kernels, and are kept until a pair may be missing.
/// Pairs in single precision; the same bits for any number of threads.
template <int Dim>
class VariableSums {
 public:
  /// `frame` fits all positions to come. Of `count` particles only the targets may move.
  VariableSums(const FixedPoint<Dim>& frame, Index count, std::vector<Index> targets);

  /// Sums for positions `r` [m] and volumes `volume` [m^Dim] of all particles and the smoothing
  /// lengths `h` [m] of the targets; only their `density` and `gradient` [1/m] are written.
  void compute(std::span<const Vec<Dim>> r, std::span<const double> volume,
               std::span<const double> h, std::span<double> density, std::span<Vec<Dim>> gradient);

  /// Neighbor searches so far.
  Index searches() const { return searches_; }

 private:
  /// Targets of similar smoothing length, in cell order.
  struct Group {
    double radius = 0;  // of the list [m]
    std::vector<std::uint32_t> particle;
    Records<Dim, float> records;
    NeighborList list;
  };

  bool lists_hold(std::span<const Vec<Dim>> r, std::span<const double> h);
  void search(std::span<const Vec<Dim>> r, std::span<const double> h);

  FixedPoint<Dim> frame_;
  std::vector<Index> targets_;
  std::vector<std::int32_t> group_;  // of each particle; -1: no target
  CellGrid<Dim> grid_;
  std::vector<std::uint32_t> order_;   // particle at each slot of the grid
  std::vector<Vec<Dim>> searched_at_;  // positions of the last search
  std::vector<Group> groups_;
  Records<Dim, float> records_;  // by slot
  double approach_ = 0;          // of two particles in a step, as last measured [m]
  Index age_ = 0;                // steps since the last search
  Index searches_ = 0;
};

extern template class VariableSums<2>;
extern template class VariableSums<3>;

}  // namespace sphgeo
