#pragma once
// What has crossed the boundaries that let particles in and out.

#include <map>
#include <span>
#include <string>

#include "core/state_io.h"
#include "core/types.h"

namespace sphgeo {

/// What came in and went out through one boundary so far; per metre of depth in 2D.
template <int Dim>
struct Exchanged {
  double entered = 0, left = 0;          ///< particles
  double mass = 0;                       ///< that came in, less what went out, kg
  Vec<Dim> momentum = Vec<Dim>::Zero();  ///< the same, kg m/s
  double energy = 0;                     ///< kinetic and potential, the same, J

  /// Adds what a particle brings (sign 1) or takes away (-1).
  void add(double sign, double m, const Vec<Dim>& at, const Vec<Dim>& v, const Vec<Dim>& gravity) {
    mass += sign * m;
    momentum += sign * m * v;
    energy += sign * m * (0.5 * v.squaredNorm() - gravity.dot(at));
  }
};

/// The accounts of all such boundaries, by name.
template <int Dim>
class BoundaryLedger {
 public:
  /// Made at the first call.
  Exchanged<Dim>& operator[](const std::string& boundary) { return accounts_[boundary]; }
  const std::map<std::string, Exchanged<Dim>>& accounts() const { return accounts_; }

  void save(StateSink& sink) const {
    for (const auto& [name, account] : accounts_) {
      const std::string at = "exchanged/" + name + "/";
      sink.put_number(at + "entered", account.entered);
      sink.put_number(at + "left", account.left);
      sink.put_number(at + "mass", account.mass);
      sink.put(at + "momentum", std::span<const double>(account.momentum.data(), Dim));
      sink.put_number(at + "energy", account.energy);
    }
  }
  /// Of the accounts that exist.
  void load(const StateSource& source) {
    for (auto& [name, account] : accounts_) {
      const std::string at = "exchanged/" + name + "/";
      account.entered = source.number(at + "entered");
      account.left = source.number(at + "left");
      account.mass = source.number(at + "mass");
      source.get(at + "momentum", std::span<double>(account.momentum.data(), Dim));
      account.energy = source.number(at + "energy");
    }
  }

 private:
  std::map<std::string, Exchanged<Dim>> accounts_;
};

}  // namespace sphgeo
