#include "deck/motion.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/csv_table.h"
#include "core/direction.h"
#include "core/text.h"
#include "deck/table_columns.h"

namespace sphgeo {
namespace {

// Small against any prescribed motion, large enough that the second difference of a smooth formula
// keeps eight digits.
constexpr double difference_step = 1e-4;

// Cubic Hermite interpolation with finite-difference slopes: a table then has a continuous
// velocity.
double interpolate(const std::vector<double>& t, const std::vector<double>& y, double at) {
  if (at <= t.front()) return y.front();
  if (at >= t.back()) return y.back();
  const auto k = static_cast<std::size_t>(std::upper_bound(t.begin(), t.end(), at) - t.begin()) - 1;
  const auto slope = [&](std::size_t i) {
    const std::size_t lo = i == 0 ? 0 : i - 1, hi = std::min(i + 1, t.size() - 1);
    return (y[hi] - y[lo]) / (t[hi] - t[lo]);
  };
  const double dt = t[k + 1] - t[k], s = (at - t[k]) / dt;
  const double s2 = s * s, s3 = s2 * s;
  return (2 * s3 - 3 * s2 + 1) * y[k] + (s3 - 2 * s2 + s) * dt * slope(k) +
         (3 * s2 - 2 * s3) * y[k + 1] + (s3 - s2) * dt * slope(k + 1);
}

}  // namespace

Schema<Motion> Motion::schema() {
  Schema<Motion> s("motion", "prescribed rigid motion of a boundary or of a clamped region");
  s.optional("displacement", &Motion::displacement, unit::length, "displacement as formulas of t");
  s.optional("angle", &Motion::angle, unit::angle, "rotation angle as a formula of t");
  s.optional("axis", &Motion::axis, unit::none, "axis of the rotation; y turns the x-z plane")
      .keep_y();
  s.optional("center", &Motion::center, unit::length, "a point on the axis of the rotation");
  s.optional("table", &Motion::table, unit::none,
             "table with a column t and any of x, y, z, angle, added to the formulas; SI, or units "
             "in the headings: x [mm]");
  s.optional("waves", &Motion::waves, unit::none,
             "waves by a piston, from the start of the motion on; added to the formulas");
  s.optional("from", &Motion::from, unit::time, "at rest before this time");
  s.optional("until", &Motion::until, unit::time, "at rest after this time");
  s.check([](Motion& m, CheckContext& c) {
    m.axis = direction_of(m.axis);
    if (m.axis.isZero(0))
      c.error("axis", "the axis has no direction", "give a vector that is not zero");
    if (m.until && !(*m.until > m.from))
      c.error("until", "the motion ends before it begins", "until must be later than from");
    if (!m.table) return;
    try {
      m.read_table(c.dimension());
    } catch (const std::exception& e) {
      c.error("table", e.what(),
              "columns t and any of x, y, z, angle, with units in brackets where they are not SI: "
              "t [ms], x [mm], angle [deg]");
    }
  });
  return s;
}

void Motion::read_table(int dimension) {
  const CsvTable rows = read_csv_table(table->path);
  check_columns(rows, {"t", "time", "x", "y", "z", "angle"});
  if (rows.has("time") && rows.has("t"))
    throw TableError(rows.header_place() + ": the columns 't' and 'time' are the same");
  times_ = si_column(rows, rows.has("time") ? "time" : "t", unit::time);
  if (times_.size() < 2) throw TableError(table->path + ": a motion needs at least two rows");
  for (std::size_t k = 1; k < times_.size(); ++k)
    if (!(times_[k] > times_[k - 1]))
      throw TableError(rows.place(k) + ": the times must rise from row to row");
  if (times_.front() > from)
    throw TableError(fmt::format(
        "{}: the table begins at t = {} s, and where the wall is before is not known; add a row "
        "for t = 0, subtract {} s from all times, or let the motion begin there (from: {})",
        rows.place(0), exact(times_.front()), exact(times_.front()), exact(times_.front())));
  const char* names[] = {"x", "y", "z", "angle"};
  bool moves = false;
  for (std::size_t k = 0; k < 4; ++k) {
    if (!rows.has(names[k])) continue;
    columns_[k] = si_column(rows, names[k], k < 3 ? unit::length : unit::angle);
    moves = true;
    constexpr double farthest = 1e9;  // m or rad
    for (std::size_t row = 0; row < columns_[k].size(); ++row)
      if (!(std::abs(columns_[k][row]) <= farthest))
        throw TableError(fmt::format("{}: {} = {}: is the unit right?", rows.place(row), names[k],
                                     exact(columns_[k][row])));
    if (dimension == 2 && k == 1 &&
        std::any_of(columns_[k].begin(), columns_[k].end(), [](double y) { return y != 0; }))
      throw TableError(rows.header_place() + ": a 2D scene moves in x and z, not in y");
  }
  if (!moves) throw TableError(rows.header_place() + ": no column moves anything");
}

double Motion::clamp(double t) const { return std::max(from, until ? std::min(t, *until) : t); }

Motion::Pose Motion::pose(double t) const {
  const double at = clamp(t);
  const Vec3 nowhere = Vec3::Zero();
  Pose p{{displacement[0](nowhere, at), displacement[1](nowhere, at), displacement[2](nowhere, at)},
         angle(nowhere, at)};
  for (int k = 0; k < 3; ++k)
    if (!columns_[static_cast<std::size_t>(k)].empty())
      p.shift[k] += interpolate(times_, columns_[static_cast<std::size_t>(k)], at);
  if (waves) p.shift += waves->displacement(at - from);
  if (!columns_[3].empty()) p.angle += interpolate(times_, columns_[3], at);
  return p;
}

Vec3 Motion::placed(const Vec3& reference, const Pose& p) const {
  if (p.angle == 0.0) return reference + p.shift;
  return center + Eigen::AngleAxisd(p.angle, axis) * (reference - center) + p.shift;
}

Vec3 Motion::turned(const Vec3& reference, const Pose& p) const {
  return p.angle == 0.0 ? reference : Vec3(Eigen::AngleAxisd(p.angle, axis) * reference);
}

Motion::Moment::Moment(const Motion& motion, double middle, double end)
    : motion_(motion),
      moves_(motion.moves_at(middle)),
      end_(motion.pose(end)),
      before_(motion.pose(middle - difference_step)),
      middle_(motion.pose(middle)),
      after_(motion.pose(middle + difference_step)) {}

Vec3 Motion::Moment::velocity(const Vec3& reference) const {
  if (!moves_) return Vec3::Zero();
  return (motion_.placed(reference, after_) - motion_.placed(reference, before_)) /
         (2 * difference_step);
}

Vec3 Motion::Moment::acceleration(const Vec3& reference) const {
  if (!moves_) return Vec3::Zero();
  return (motion_.placed(reference, after_) - 2 * motion_.placed(reference, middle_) +
          motion_.placed(reference, before_)) /
         (difference_step * difference_step);
}

Vec3 Motion::position(const Vec3& reference, double t) const { return placed(reference, pose(t)); }
Vec3 Motion::velocity(const Vec3& reference, double t) const {
  return Moment(*this, t, t).velocity(reference);
}
Vec3 Motion::acceleration(const Vec3& reference, double t) const {
  return Moment(*this, t, t).acceleration(reference);
}
Vec3 Motion::direction(const Vec3& reference, double t) const { return turned(reference, pose(t)); }

double Motion::max_speed(const Vec3& reference, double end) const {
  double fastest = 0;
  constexpr int samples = 1000;
  for (int k = 0; k <= samples; ++k)
    fastest = std::max(fastest, velocity(reference, end * k / samples).norm());
  return fastest;
}

}  // namespace sphgeo
