#pragma once
// How a result changes with the spacing: observed order, Richardson's value, grid convergence
// index.

#include <optional>
#include <span>
#include <string>

namespace sphgeo {

/// One result at one spacing.
struct Level {
  double spacing = 0;           ///< m
  double value = 0;             ///< of the result
  std::optional<double> error;  ///< against the reference, >= 0; empty without one
};

/// What the three finest levels say (Celik et al. 2008, J. Fluids Eng. 130, 078001; Roache 1994).
struct Convergence {
  std::optional<double> order;         ///< observed; of the values, else of the errors; empty: none
  std::string order_from;              ///< values | errors | empty
  std::optional<double> extrapolated;  ///< Richardson's value at spacing zero; monotone only
  std::optional<double> uncertainty;   ///< of the finest value, in its own unit
  std::optional<double> gci;           ///< grid convergence index: uncertainty / |finest value|
  /// monotone | oscillatory | not in the asymptotic range | too few levels | unchanged
  std::string label;
};

/// The levels coarsest first, with different spacings. With three or more levels the safety factor
/// is 1.25 when they converge in a monotone way with an order between 0.5 and 4. Oscillating values
/// have half of their range, times that factor, for uncertainty (Stern et al. 2001), and no order
/// of their own. In all other cases the factor is 3 and the order that of the errors if they have
/// one between 0.5 and 2, else 1.
Convergence convergence(std::span<const Level> levels);

/// The exponent p of error = c * spacing^p by least squares in logarithms; empty with fewer than
/// two errors above zero.
std::optional<double> order_of_errors(std::span<const Level> levels);

}  // namespace sphgeo
