#include "run/set_frame.h"

#include <algorithm>
#include <cstdint>
#include <span>

#include "core/parallel.h"

namespace sphgeo {

template <int Dim>
FileImage set_frame(const ParticleSet<Dim>& set, const std::vector<std::string>& names,
                    const VtuOptions& options) {
  const auto& x = set.vector(fields::position);
  std::vector<VtuField> columns;
  std::vector<std::vector<double>> vectors;  // of 2D, with three components each
  vectors.reserve(set.fields().size());
  const Id* ids = set.ids().data();
  const auto n = static_cast<std::size_t>(set.size());
  columns.push_back({"id", "", 1, std::span<const std::uint64_t>(ids, n)});
  for (const std::string& name : names) {
    const auto it = set.fields().find(name);
    if (it == set.fields().end() || name == "id" || name == "position") continue;
    const FieldSpec& spec = it->second->spec();
    if (spec.type == FieldType::scalar)
      columns.push_back(
          {name, spec.unit.symbol, 1, std::span<const double>(set.scalar(spec).data(), n)});
    else if (spec.type == FieldType::tag)
      columns.push_back({name, "", 1, std::span<const std::int32_t>(set.tag(spec).data(), n)});
    else if (spec.type == FieldType::tensor)
      columns.push_back({name, spec.unit.symbol, 6,
                         std::span<const double>(set.tensor(spec).data()->data(), 6 * n)});
    else if (spec.type == FieldType::vector) {
      if constexpr (Dim == 3) {
        columns.push_back({name, spec.unit.symbol, 3,
                           std::span<const double>(set.vector(spec).data()->data(), 3 * n)});
        continue;
      }
      auto& flat = vectors.emplace_back();
      flat.resize(3 * n);
      const auto& values = set.vector(spec);
      parallel_for(set.size(), [&](Index i) {
        const Vec3 v = to_space<Dim>(values[i]);
        std::copy_n(v.data(), 3, flat.data() + 3 * i);
      });
      columns.push_back({name, spec.unit.symbol, 3, std::span<const double>(flat)});
    }
  }
  return vtu_image(VtuPoints(set.size(), [&](Index i) { return to_space<Dim>(x[i]); }), columns,
                   options);
}

FileImage boundary_frame(const BoundaryMesh& mesh, const Model& model, double time) {
  VtuOptions options;
  options.time = time;
  return vtu_mesh_image(points_at(mesh, model, time), model.dimension, mesh.corners, {},
                        {{"part", "", 1, std::span<const std::int32_t>(mesh.part)}}, options);
}

template FileImage set_frame<2>(const ParticleSet<2>&, const std::vector<std::string>&,
                                const VtuOptions&);
template FileImage set_frame<3>(const ParticleSet<3>&, const std::vector<std::string>&,
                                const VtuOptions&);

}  // namespace sphgeo
