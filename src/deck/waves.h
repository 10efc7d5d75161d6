#pragma once
// Regular waves by a piston that moves as linear theory or that of second order says.

#include <optional>

#include "core/types.h"
#include "deck/schema.h"

namespace sphgeo {

/// Waves of a height and a period on water of a depth (key `waves` of a motion).
struct Waves {
  double height = 0;               ///< H, from trough to crest, m
  double period = 0;               ///< T, s
  double depth = 0;                ///< d of the water at rest, m
  double gravity = 9.81;           ///< m/s2
  Vec3 direction = Vec3::UnitX();  ///< that the waves run in
  Index order = 1;                 ///< of the theory: 1 linear, 2 Madsen's
  std::optional<double> ramp;      ///< in which the stroke grows from zero, s; empty: two periods
  bool absorb = false;             ///< whether the piston takes up waves that come back to it
  static Schema<Waves> schema();

  /// k of omega^2 = g k tanh(k d), 1/m.
  double wave_number() const;
  /// S of a piston: H / S = 2 (cosh 2kd - 1) / (sinh 2kd + 2kd) (Biesel; Dean and Dalrymple 1991,
  /// section 6.3), m.
  double stroke() const;
  /// Amplitude of the motion with half the period that keeps a second, free wave from leaving the
  /// piston (Madsen 1971): H^2 / (32 d) (3 cosh kd / sinh^3 kd - 2 S / H), m. 0 for order 1.
  double second_amplitude() const;
  /// Of the piston at a time since its start, m; without what it moves to take up waves.
  Vec3 displacement(double t) const;

  /// Height over still water of the waves that it sends out, at a distance from where it rests: the
  /// progressive wave with what it has of second order, and what stays near the piston, m.
  double elevation(double distance, double t) const;
  /// What stays near a piston that swings with the period of the waves: height of the surface at a
  /// distance over the piston's displacement, in phase with it (Biesel; Dean and Dalrymple 1991,
  /// section 6.3).
  double evanescent(double distance) const;
  /// Speed of a piston that takes up a wave over the height of that wave before it, 1/s: omega S /
  /// H, the theory of the wave maker turned round; sqrt(g / d) in shallow water (Schaeffer and
  /// Klopman 2000).
  double absorbing_rate() const;

 private:
  double omega() const;
  double share(double t) const;  // of the full stroke, while it grows
};

}  // namespace sphgeo
