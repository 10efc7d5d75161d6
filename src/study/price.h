#pragma once
// Accuracy against time: the Pareto front of runs, and a sentence that states which spacing an
// error requires.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sphgeo {

/// Cost and error of one run.
struct Offer {
  std::string setting;          ///< "0.02", as the user wrote it
  double spacing = 0;           ///< particle spacing dp, m
  double wall_s = 0;            ///< s
  std::optional<double> error;  ///< >= 0; empty: unknown
};

/// For each offer whether no other is at least as accurate and at least as fast (the Pareto front).
std::vector<bool> worth_their_time(std::span<const Offer> offers);

/// How errors of a result are written.
struct ErrorScale {
  bool relative = true;  ///< errors are fractions, given in per cent; else in the result's own unit
  double tolerance = 0;  ///< of the deck; 0: none
  std::string reference;  ///< "the reference" or "the finest run"
};

/// The spacing and time that an error requires; offers are ordered from coarse to fine:
/// "3 % needs dp 0.03 (about 4 min); 1 % about dp 0.012 (about 1 h 10 min)". Errors between the
/// runs are interpolated, those beyond the finest run extrapolated with the observed order, to a
/// quarter of its spacing at most. States when the error does not fall.
std::string price_of_spacing(std::span<const Offer> offers, const ErrorScale& scale);

/// Results of each setting when another key than the spacing is varied, with the cheapest within
/// tolerance.
std::string price_of_settings(std::span<const Offer> offers, const ErrorScale& scale);

}  // namespace sphgeo
