#pragma once
// Prescribed rigid motion of a boundary or of a part of a body: formulas of t, or a table.

#include <memory>
#include <optional>
#include <vector>

#include "deck/expression.h"
#include "deck/schema.h"
#include "deck/waves.h"

namespace sphgeo {

/// A rigid motion x(t) = c + R(angle(t)) (X - c) + d(t), from a start time on, frozen after an end.
struct Motion {
  std::array<Expression, 3> displacement;  ///< d(t), m
  Expression angle{0.0};                   ///< rotation angle, rad
  Vec3 axis = Vec3(0, 1, 0);               ///< axis of the rotation; y turns the x-z plane
  Vec3 center = Vec3::Zero();              ///< a point on the axis, m
  std::optional<FilePath> table;  ///< columns t and any of x, y, z, angle; added to the formulas
  std::optional<Waves> waves;     ///< of a wave maker; added to the formulas
  double from = 0.0;              ///< at rest before, s
  std::optional<double> until;    ///< and after, s

  static Schema<Motion> schema();

  /// Shift and angle at a time: the same for all points.
  struct Pose {
    Vec3 shift;
    double angle;
  };
  /// The motion over a time step: position and direction at its end, velocity and acceleration at
  /// its middle, as the four functions below give them. For many points at once: formulas, tables
  /// and waves are evaluated once.
  class Moment {
   public:
    Moment(const Motion& motion, double middle, double end);
    Vec3 position(const Vec3& reference) const { return motion_.placed(reference, end_); }
    Vec3 velocity(const Vec3& reference) const;
    Vec3 acceleration(const Vec3& reference) const;
    Vec3 direction(const Vec3& reference) const { return motion_.turned(reference, end_); }

   private:
    const Motion& motion_;
    bool moves_;
    Pose end_, before_, middle_, after_;
  };

  /// Where the point that was at `reference` at t = 0 is at time t.
  Vec3 position(const Vec3& reference, double t) const;
  Vec3 velocity(const Vec3& reference, double t) const;
  Vec3 acceleration(const Vec3& reference, double t) const;
  /// The direction that was `reference` at t = 0.
  Vec3 direction(const Vec3& reference, double t) const;
  /// Largest speed of the point over [0, end], sampled.
  double max_speed(const Vec3& reference, double end) const;

 private:
  // Reads the table. Throws IoError or TableError with file and line.
  void read_table(int dimension);
  Pose pose(double t) const;
  Vec3 placed(const Vec3& reference, const Pose& p) const;
  Vec3 turned(const Vec3& reference, const Pose& p) const;
  double clamp(double t) const;
  bool moves_at(double t) const { return t > from && (!until || t < *until); }

  std::vector<double> times_;                   // of the table
  std::array<std::vector<double>, 4> columns_;  // x, y, z, angle
};

}  // namespace sphgeo
