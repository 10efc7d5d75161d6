#pragma once
// Selection of the points of the reference lattice that become water particles.

#include <cstdint>
#include <string>
#include <vector>

#include "scene/water_target.h"

namespace sphgeo {

/// A cell of the reference lattice as a candidate (section 3.3, below Eq. 82).
struct Candidate {
  Vec3 at;        ///< its centre, m
  double water;   ///< volume of water in it over dp^Dim, above 0, at most 1
  bool near_cut;  ///< within reach of a cell that is not completely filled with water
};

/// All cells of the lattice of a body (as fill_lattice places it) that hold water, x fastest. The
/// volume of water in a cell that a surface of the body or of a soil cuts is summed over finer
/// cells, and over two Gauss points an axis elsewhere. `reach` (m) is that of Candidate::near_cut.
/// Throws Error (usage) as fill_lattice, and where a volume fraction is no number within [0, 1] or
/// leaves less water than WaterTarget::smallest.
std::vector<Candidate> candidates(const Shape& body, const WaterTarget& target, double dp, int dim,
                                  double reach);

/// Volume of water in all candidates over dp^Dim.
double water_volume(const std::vector<Candidate>& all);

/// How candidates are drawn.
enum class Acceptance {
  /// In the order of a space-filling curve the volume of water is summed; a particle stands where
  /// the sum
  /// passes k + u_k, u_k drawn within [0, 1) about its middle: each stretch of the curve, and so
  /// each
  /// aligned square or cube, gets its own share to within one or two particles.
  stratified,
  /// Each by its own draw: the number in any region scatters as the square root of its mean.
  independent
};

/// Numbers of the accepted candidates, ascending: always the whole ones, and of the others as many
/// as make the total water_volume() rounded to the nearest number. Draws are hashes of seed and
/// index alone. `dim` and `dp` (m) make the curve.
std::vector<std::size_t> accept(const std::vector<Candidate>& all, Acceptance kind,
                                std::uint64_t seed, double dp, int dim);

/// Position of a cell on the Hilbert curve over a cube of 2^bits cells per edge.
std::uint64_t hilbert_index(const std::uint32_t* cell, int dim, int bits);

}  // namespace sphgeo
