#pragma once
// What accuracy costs: the runs that are worth their time, and a sentence that says what an error
// needs.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sphgeo {

/// One run as a buyer sees it.
struct Offer {
  std::string setting;          ///< "0.02", as the user wrote it
  double spacing = 0;           ///< particle spacing dp, m
  double wall_s = 0;            ///< s
  std::optional<double> error;  ///< >= 0; empty: unknown
};

/// For each offer whether no other is at least as accurate and at least as fast (the Pareto front).
std::vector<bool> worth_their_time(std::span<const Offer> offers);

/// How errors of a result are spoken of.
struct ErrorScale {
  bool relative = true;   ///< errors are shares, told in per cent; else in the result's own unit
  double tolerance = 0;   ///< of the deck; 0: none
  std::string reference;  ///< "the reference" or "the finest run"
};

/// What an error needs when the spacing falls from offer to offer (coarsest first):
/// "3 % needs dp 0.03 (about 4 min); 1 % about dp 0.012 (about 1 h 10 min)". Errors between the
/// runs are interpolated, those beyond the finest run extrapolated with the observed order, to a
/// quarter of its spacing at most. Without an error that falls it says so.
std::string price_of_spacing(std::span<const Offer> offers, const ErrorScale& scale);

/// What each setting gives when another key than the spacing is varied, the cheapest within
/// tolerance named.
std::string price_of_settings(std::span<const Offer> offers, const ErrorScale& scale);

}  // namespace sphgeo
