#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text.h"
#include "geometry/scene_check.h"
#include "geometry/shapes.h"
#include "geometry/stl_file.h"

namespace sphgeo {

namespace {

const Register<Shape, Stl> registered_stl{"stl"};

Vec3 in_plane(const Vec2& p) { return {p.x(), 0.0, p.y()}; }

/// The segments in which a surface cuts the plane y = 0, directed so that the solid is on a fixed
/// side. A corner exactly in the plane counts as above it, so that no crossing is lost or doubled.
std::vector<Vec2> cut_at_y0(const Triangles& mesh) {
  std::vector<Vec2> ends;
  for (const auto& f : mesh.faces) {
    std::array<Vec2, 2> end;
    int found = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& a = mesh.points[static_cast<std::size_t>(f[k])];
      const Vec3& b = mesh.points[static_cast<std::size_t>(f[(k + 1) % 3])];
      if ((a.y() >= 0.0) == (b.y() >= 0.0)) continue;
      // Always from the lower to the upper end, so that neighbours get the same point.
      const Vec3& low = a.y() < b.y() ? a : b;
      const Vec3& high = a.y() < b.y() ? b : a;
      const double s = -low.y() / (high.y() - low.y());
      const Vec3 p = low + s * (high - low);
      if (found < 2) end[static_cast<std::size_t>(b.y() >= 0.0)] = {p.x(), p.z()};
      ++found;
    }
    if (found == 2) ends.insert(ends.end(), end.begin(), end.end());
  }
  return ends;
}

}  // namespace

Schema<Stl> Stl::schema() {
  Schema<Stl> s(
      "stl",
      "A closed surface of triangles from an STL file, text or binary: scaled, turned and "
      "moved in this order. In 2D its section with the plane y = 0.");
  s.required("file", &Stl::file, unit::none, "The STL file, relative to the deck.");
  s.optional("scale", &Stl::scale, unit::none,
             "Factor that turns the file's lengths into metres: 0.001 for millimetres.")
      .above(0);
  s.optional("rotate", &Stl::rotate, unit::angle,
             "Angle, right-handed about `axis` through the origin.");
  s.optional("axis", &Stl::axis, unit::none, "Direction of the axis of rotation.").keep_y();
  s.optional("translate", &Stl::translate, unit::length,
             "Displacement, applied last. In 2D its y chooses the section.")
      .keep_y();
  s.optional("weld_tolerance", &Stl::weld_tolerance, unit::length,
             "Corners nearer than this become one; auto is a millionth of the surface's size.")
      .at_least(0);
  s.check([](Stl& b, CheckContext& c) {
    set_scene(b, c);
    if (b.axis.isZero(0)) return c.error("axis", "the axis has no direction");
    prepare_or_report(b, c, "file");
  });
  return s;
}

void Stl::prepare() {
  StlSurface surface = read_stl(file.path);
  Triangles mesh = std::move(surface.mesh);
  remarks_ = std::move(surface.remarks);
  const Mat3 turn = rotate == 0.0
                        ? Mat3(Mat3::Identity())
                        : Eigen::AngleAxisd(rotate, direction_of(axis)).toRotationMatrix();
  Aabb around;
  for (Vec3& p : mesh.points) {
    p = turn * (scale * p) + translate;
    around.extend(p);
  }
  // Beyond these lengths products of four of them leave the range of a double.
  constexpr double longest = 1e12, shortest = 1e-12;
  const double size = (around.hi - around.lo).norm(),
               reach = around.lo.cwiseAbs().cwiseMax(around.hi.cwiseAbs()).maxCoeff();
  if (!(reach <= longest && size >= shortest))
    throw IoError(file.path, "the surface is " + exact(size) + " m across and reaches " +
                                 exact(reach) + " m from the origin: is 'scale' right?");
  if (reach > 1000 * size)
    remarks_.push_back(
        fmt::format("it is {:.4g} m across and lies {:.6g} m from the origin: "
                    "coordinates of a map? `translate` moves it",
                    size, reach));
  const Index dropped = weld(mesh, weld_tolerance.value_or(1e-6 * size));
  if (mesh.faces.empty())
    throw IoError(file.path, "no triangle is left after welding: is weld_tolerance too large?");
  const Index duplicates = drop_duplicates(mesh);
  health_ = repair_orientation(mesh);
  health_.degenerate_faces = dropped;
  health_.duplicate_faces = duplicates;
  section_.clear();
  section_tree_ = {};
  if (flat) {
    section_ = cut_at_y0(mesh);
    if (section_.empty())
      throw IoError(file.path, "the surface does not intersect the plane y = 0 of the 2D scene");
    std::vector<Aabb> boxes(section_.size() / 2);
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      boxes[k].extend(in_plane(section_[2 * k]));
      boxes[k].extend(in_plane(section_[2 * k + 1]));
    }
    section_tree_ = BoxTree(boxes);
  }
  surface_ = SurfaceDistance(std::move(mesh));
}

double Stl::signed_distance(const Vec3& at) const {
  if (!flat) return surface_.signed_distance(at);
  const Vec3 p{at.x(), 0.0, at.z()};
  const double best2 =
      section_tree_.nearest(p, std::numeric_limits<double>::infinity(), [&](std::int32_t k) {
        const auto i = 2 * static_cast<std::size_t>(k);
        const double d = segment_distance(p, in_plane(section_[i]), in_plane(section_[i + 1]));
        return d * d;
      });
  const double d = std::sqrt(best2);
  if (!surface_.box().contains(p)) return d;
  return surface_.winding_number(p) > 0.5 ? -d : d;
}

Aabb Stl::box() const {
  if (!flat) return surface_.box();
  Aabb b;
  for (const Vec2& p : section_) b.extend(in_plane(p));
  return b;
}

void Stl::inspect(CheckContext& context) const {
  const auto count = [](Index n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
  };
  if (health_.open_edges > 0) {
    const Vec3& at = health_.open_at;
    context.error(
        "file",
        "the surface is open: " + count(health_.open_edges, "edge has", "edges have") +
            " only one face, one of them near [" + std::to_string(at.x()) + ", " +
            std::to_string(at.y()) + ", " + std::to_string(at.z()) + "] m",
        "close the holes, or raise weld_tolerance if corners that should coincide are apart");
  }
  for (const std::string& remark : remarks_) context.warning("file", "the STL file: " + remark);
  if (health_.duplicate_faces > 0)
    context.warning("file", count(health_.duplicate_faces, "face is", "faces are") +
                                " there twice; one of each was left out");
  if (health_.non_manifold_edges > 0)
    context.warning("file",
                    count(health_.non_manifold_edges, "edge has", "edges have") +
                        " more than two faces (the surface is not manifold there)",
                    "separate or join the bodies that touch");
  if (health_.flipped_faces > 0)
    context.warning("file",
                    count(health_.flipped_faces, "face is", "faces are") +
                        " turned against their neighbours; they were flipped",
                    "make the order of corners consistent in the file");
  if (const double inner = surface_.inner_faces(); inner > 0.005)
    context.warning("file",
                    std::to_string(std::lround(100 * inner)) +
                        " % of the faces lie inside of the solid: closed parts overlap or contain "
                        "each other, and these faces act as surfaces",
                    "unite the parts where the file comes from, or give each as a file of its own "
                    "in a shape of type union");
  if (health_.inside_out)
    context.warning("file", "the faces point inwards; the surface was turned inside out");
  if (health_.degenerate_faces > 0)
    context.warning("file", count(health_.degenerate_faces, "face has", "faces have") +
                                " no area and were left out");
}

}  // namespace sphgeo
