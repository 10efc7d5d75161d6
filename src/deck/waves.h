#pragma once
// Regular waves by a piston after linear or second-order wave maker theory.

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
  Vec3 direction = Vec3::UnitX();  ///< direction of propagation
  Index order = 1;                 ///< of the theory: 1 linear, 2 Madsen's
  std::optional<double> ramp;      ///< in which the stroke grows from zero, s; empty: two periods
  bool absorb = false;             ///< active wave absorption
  static Schema<Waves> schema();

  /// k of omega^2 = g k tanh(k d), 1/m.
  double wave_number() const;
  /// S of a piston: H / S = 2 (cosh 2kd - 1) / (sinh 2kd + 2kd) (Biesel; Dean and Dalrymple 1991,
  /// section 6.3), m.
  double stroke() const;
  /// Amplitude of the motion with half the period that suppresses the free second-order wave
  /// (Madsen 1971): H^2 / (32 d) (3 cosh kd / sinh^3 kd - 2 S / H), m. 0 for order 1.
  double second_amplitude() const;
  /// Displacement of the piston at a time since its start, m; without active wave absorption.
  Vec3 displacement(double t) const;

  /// Surface elevation of the generated waves at a distance from the piston's rest position: the
  /// progressive wave with its second-order part, and the evanescent modes near the piston, m.
  double elevation(double distance, double t) const;
  /// Evanescent modes near a piston that oscillates with the period of the waves: surface elevation
  /// at a distance over the piston's displacement, in phase with it (Biesel; Dean and Dalrymple
  /// 1991, section 6.3).
  double evanescent(double distance) const;
  /// Speed of an absorbing piston over the elevation of the wave at it, 1/s: omega S / H, the
  /// inverse of the wave maker theory; sqrt(g / d) in shallow water (Schaeffer and Klopman
  /// 2000).
  double absorbing_rate() const;

 private:
  double omega() const;
  double share(double t) const;  // of the full stroke, while it grows
};

}  // namespace sphgeo
