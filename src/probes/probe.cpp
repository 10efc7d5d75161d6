#include "probes/probe.h"

#include <Eigen/LU>

namespace sphgeo {

std::vector<Column> vector_columns(const Model& model, const std::string& prefix, const Unit& unit,
                                   const std::string& sentence) {
  std::vector<Column> columns;
  for (const char axis : {'x', 'y', 'z'})
    if (axis != 'y' || model.dimension == 3)
      columns.push_back({prefix + axis, unit.symbol, sentence + ", " + axis + " component"});
  return columns;
}

void store_vector(const SceneView& scene, const Vec3& value, std::span<std::optional<double>> out,
                  std::size_t first) {
  for (int k = 0; k < 3; ++k)
    if (k != 1 || scene.dimension() == 3) out[first++] = value[k];
}

PointFit::PointFit(const SceneView& scene, const std::string& set, const Vec3& at) {
  if (!scene.has_set(set)) return;
  const auto x = scene.vector(set, fields::position);
  const auto volume = scene.scalar(set, fields::volume);
  const double h = scene.smoothing_length(set);
  std::vector<double> kernel;
  std::vector<Vec3> offset;
  Vec3 mean = Vec3::Zero();
  scene.near(set, at, [&](Index i, double w) {
    particles_.push_back(i);
    kernel.push_back(w * volume(i));
    offset.push_back((x(i) - at) / h);
    support_ += kernel.back();
    mean += kernel.back() * offset.back();
  });
  // A few particles at the edge of the kernel support are not sufficient for a measurement.
  if (particles_.size() < 3 || support_ < 0.15) return;
  supported_ = true;
  mean /= support_;
  // Weighted fit a + b.(x - at): the estimate a is a weighted sum of the values, with weights
  // w (1 - mean.S^-1 (offset - mean)), S the second moment about the mean.
  Mat3 second = Mat3::Zero();
  for (std::size_t k = 0; k < kernel.size(); ++k) {
    const Vec3 d = offset[k] - mean;
    second += kernel[k] / support_ * d * d.transpose();
  }
  if (scene.dimension() == 2) second(1, 1) = 1;
  const double size = second.trace();
  const bool linear = second.determinant() > 1e-4 * size * size * size;
  const Vec3 tilt = linear ? Vec3(second.inverse() * mean) : Vec3::Zero();
  for (std::size_t k = 0; k < kernel.size(); ++k)
    weights_.push_back(kernel[k] / support_ * (1 - tilt.dot(offset[k] - mean)));
}

double PointFit::operator()(const std::function<double(Index)>& field) const {
  double sum = 0;
  for (std::size_t k = 0; k < particles_.size(); ++k) sum += weights_[k] * field(particles_[k]);
  return sum;
}

Vec3 PointFit::operator()(const std::function<Vec3(Index)>& field) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < particles_.size(); ++k) sum += weights_[k] * field(particles_[k]);
  return sum;
}

}  // namespace sphgeo
