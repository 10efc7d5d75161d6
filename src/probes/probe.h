#pragma once
// What a probe is: named columns with units, the fields it needs, and one sample.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/column.h"
#include "deck/interfaces.h"
#include "probes/scene_view.h"

namespace sphgeo {

/// A field that a probe reads; derived ones pull their effect into the plan.
struct FieldRequest {
  std::string set;
  const FieldSpec* field;
  bool optional = false;  ///< the probe does without the field, or the set
};

/// A measurement requested by a deck. Empty values mean that no particles support it.
struct Probe : ProbeSpec {
  virtual std::vector<Column> columns(const Model& model) const = 0;
  virtual std::vector<FieldRequest> needs(const Model& model) const = 0;
  /// One value per column.
  virtual void sample(const SceneView& scene, std::span<std::optional<double>> out) const = 0;
  /// Reports errors of the probe in this deck, such as an unknown name.
  virtual void inspect(const Model&, CheckContext&) const {}
  /// Points that should lie inside the scene, for `check`.
  virtual std::vector<Vec3> positions() const { return {}; }
};

/// Columns of a vector: x, y, z in 3D; x, z in 2D.
std::vector<Column> vector_columns(const Model& model, const std::string& prefix, const Unit& unit,
                                   const std::string& sentence);
/// Stores a vector the way vector_columns orders it, from position `first` on.
void store_vector(const SceneView& scene, const Vec3& value, std::span<std::optional<double>> out,
                  std::size_t first = 0);

/// Estimates fields of a set at points by a weighted linear fit (moving least squares), which is
/// exact for linear fields also on a wall, where half of the support is missing.
class PointFit {
 public:
  /// Collects the particles of `set` around the point.
  PointFit(const SceneView& scene, const std::string& set, const Vec3& at);
  /// Whether enough of the set is around the point for an estimate.
  bool supported() const { return supported_; }
  /// Share of the kernel that the set fills: about 1 inside, 1/2 on a wall or surface.
  double support() const { return support_; }
  double operator()(const std::function<double(Index)>& field) const;
  Vec3 operator()(const std::function<Vec3(Index)>& field) const;

 private:
  std::vector<Index> particles_;
  std::vector<double> weights_;  // of the estimate
  double support_ = 0;
  bool supported_ = false;
};

}  // namespace sphgeo
