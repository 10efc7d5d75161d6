#pragma once
// Read access of probes to a running scene, without its dimension.

#include <functional>
#include <string>
#include <vector>

#include "core/types.h"
#include "deck/model.h"
#include "particles/fields.h"
#include "sph/parameters.h"

namespace sphgeo {

/// Particles and mass that have crossed a boundary since t = 0.
struct Crossings {
  double entered = 0, left = 0;  ///< particles
  double mass = 0;               ///< inflow minus outflow, kg; per metre of depth in 2D
};

/// Read-only view of all particle sets at one moment; vectors have y = 0 in 2D.
class SceneView {
 public:
  virtual ~SceneView() = default;
  virtual const Model& model() const = 0;
  virtual const Parameters& parameters() const = 0;
  virtual double time() const = 0;
  virtual bool has_set(const std::string& set) const = 0;
  virtual bool has_field(const std::string& set, const FieldSpec& field) const = 0;
  virtual Index size(const std::string& set) const = 0;
  virtual double spacing(const std::string& set) const = 0;
  virtual double smoothing_length(const std::string& set) const = 0;
  /// One value of a field of a set; throws std::logic_error when the set has no such field.
  virtual std::function<double(Index)> scalar(const std::string& set,
                                              const FieldSpec& field) const = 0;
  virtual std::function<Vec3(Index)> vector(const std::string& set,
                                            const FieldSpec& field) const = 0;
  virtual std::function<Sym3(Index)> tensor(const std::string& set,
                                            const FieldSpec& field) const = 0;
  virtual std::function<std::int32_t(Index)> tag(const std::string& set,
                                                 const FieldSpec& field) const = 0;
  /// Calls f(i, W) for all particles of the set whose kernel reaches the point; W in 1/m^d.
  virtual void near(const std::string& set, const Vec3& at,
                    const std::function<void(Index, double)>& f) const = 0;
  /// All zero for a boundary that is not an open one.
  virtual Crossings crossings(const std::string& boundary) const = 0;
  /// The box of the scene, m.
  virtual Aabb domain() const = 0;

  int dimension() const { return model().dimension; }
};

}  // namespace sphgeo
