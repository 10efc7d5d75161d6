// STL: both formats, health of surfaces, distance and inside, sections, broken files.

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "geometry/mesh.h"
#include "geometry/stl_file.h"
#include "read_shape.h"

using namespace sphgeo;
using geometry_test::Hash;
using geometry_test::read_shape;

namespace {

/// A file in the temporary folder that disappears with the test.
struct TemporaryFile {
  explicit TemporaryFile(const std::string& name)
      : path((std::filesystem::temp_directory_path() / ("sphgeo_test_" + name)).string()) {}
  ~TemporaryFile() { std::filesystem::remove(path); }
  std::string path;
};

Triangles ball_mesh(double radius = 1.0, double spacing = 0.15) {
  Sphere s;
  s.radius = radius;
  SurfaceMesh m = surface_mesh(s, spacing, 3);
  return {std::move(m.points), std::move(m.triangles)};
}

Triangles cube_mesh(const Vec3& lo = Vec3::Zero(), const Vec3& hi = Vec3::Ones()) {
  Box b;
  b.min = lo;
  b.max = hi;
  SurfaceMesh m = surface_mesh(b, 0.1, 3);
  return {std::move(m.points), std::move(m.triangles)};
}

Triangles joined(Triangles a, const Triangles& b) {
  const auto shift = static_cast<std::int32_t>(a.points.size());
  a.points.insert(a.points.end(), b.points.begin(), b.points.end());
  for (const auto& f : b.faces) a.faces.push_back({f[0] + shift, f[1] + shift, f[2] + shift});
  return a;
}

void write_text_stl(const std::string& path, const Triangles& mesh) {
  std::ofstream out(path);
  out.precision(9);
  out << "solid a facet of vertex\n";  // a name that tries to mislead
  for (const auto& f : mesh.faces) {
    out << "  facet normal 0 0 0\r\n    outer loop\n";
    for (const std::int32_t k : f) {
      const Eigen::Vector3f v = mesh.points[static_cast<std::size_t>(k)].cast<float>();
      out << "      vertex " << v.x() << " " << v.y() << " " << v.z() << "\n";
    }
    out << "    endloop\n  endfacet\n";
  }
  out << "endsolid a\n";
}

std::string report(const Triangles& mesh, const std::string& more = "") {
  const TemporaryFile file("report.stl");
  write_stl(file.path, mesh);
  return read_shape("{type: stl, file: " + file.path + more + "}", 3).messages();
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("stl: text and binary give the same bits") {
    for (const Triangles& mesh : {cube_mesh(), ball_mesh()}) {
      const TemporaryFile text("text.stl"), binary("binary.stl");
      write_stl(binary.path, mesh);
      write_text_stl(text.path, mesh);
      const Triangles a = read_stl(text.path).mesh, b = read_stl(binary.path).mesh;
      REQUIRE(a.points.size() == b.points.size());
      CHECK(a.faces == b.faces);
      bool same = true;
      for (std::size_t k = 0; k < a.points.size(); ++k)
        same = same && a.points[k].cast<float>() == b.points[k].cast<float>();
      CHECK(same);
    }
  }

  TEST_CASE("stl: a cube has the distance of the box, a ball nearly that of the sphere") {
    Box box;
    box.max = Vec3::Ones();
    const SurfaceDistance cube(cube_mesh());
    Triangles fine = ball_mesh(1.0, 0.1);
    const SurfaceDistance ball(fine);
    Hash hash;
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = hash.in({Vec3::Constant(-0.5), Vec3::Constant(1.5)}, 3);
      CHECK(cube.signed_distance(p) == doctest::Approx(box.signed_distance(p)).epsilon(1e-9));
      CHECK(std::abs(ball.signed_distance(p) - (p.norm() - 1.0)) < 0.004);
      CHECK(std::abs(ball.winding_number(p) - (p.norm() < 1.0 ? 1.0 : 0.0)) <
            (std::abs(p.norm() - 1.0) > 0.01 ? 0.05 : 1.0));
    }
    CHECK(enclosed_volume(cube.mesh()) == doctest::Approx(1.0));
    CHECK(enclosed_volume(fine) == doctest::Approx(4.0 / 3.0 * std::numbers::pi).epsilon(0.01));
  }

  TEST_CASE("stl: scale, rotate, translate, weld") {
    const TemporaryFile file("placed.stl");
    write_stl(file.path, cube_mesh());
    Stl s;
    s.file.path = file.path;
    s.scale = 2.0;
    s.rotate = 0.5 * std::numbers::pi;
    s.axis = Vec3::UnitZ();
    s.translate = {10, 0, 0};
    s.prepare();
    CHECK((s.box().lo - Vec3(8, 0, 0)).norm() < 1e-9);
    CHECK((s.box().hi - Vec3(10, 2, 2)).norm() < 1e-9);
    CHECK(s.triangles().points.size() == 8);
    CHECK(s.health().open_edges == 0);
    CHECK(s.signed_distance({9, 1, 1}) == doctest::Approx(-1.0));
  }

  TEST_CASE("stl: what is wrong with a surface is reported") {
    CHECK(report(cube_mesh()).empty());

    Triangles open = cube_mesh();
    open.faces.pop_back();
    CHECK(report(open).find("open: 3 edges have only one face") != std::string::npos);

    Triangles flipped = cube_mesh();
    std::swap(flipped.faces[3][0], flipped.faces[3][1]);
    CHECK(report(flipped).find("1 face is turned") != std::string::npos);

    Triangles inside_out = cube_mesh();
    for (auto& f : inside_out.faces) std::swap(f[0], f[1]);
    CHECK(report(inside_out).find("inwards") != std::string::npos);

    // Two cubes that share one edge.
    const Triangles touching = joined(cube_mesh(), cube_mesh({1, 0, 1}, {2, 1, 2}));
    CHECK(report(touching).find("1 edge has more than two faces") != std::string::npos);

    Triangles thin = cube_mesh();
    thin.points.push_back({0.5, 0.5, 0.5});
    thin.faces.push_back({8, 8, 8});
    CHECK(report(thin).find("1 face has no area") != std::string::npos);

    // A crack of a tenth of a millimetre closes when the tolerance is raised above it.
    Triangles crack = cube_mesh();
    crack.points.push_back(crack.points[0] + Vec3(1e-4, 0, 0));
    for (auto& corner : crack.faces[0])
      if (corner == 0) corner = 8;
    CHECK(report(crack).find("open") != std::string::npos);
    CHECK(report(crack, ", weld_tolerance: 1 mm").empty());
  }

  TEST_CASE("stl: flipped faces are repaired, hollow bodies stay hollow") {
    Triangles mixed = cube_mesh();
    std::swap(mixed.faces[5][0], mixed.faces[5][1]);
    CHECK(repair_orientation(mixed).flipped_faces == 1);
    CHECK(enclosed_volume(mixed) == doctest::Approx(1.0));
    Triangles cavity = cube_mesh(Vec3::Constant(0.25), Vec3::Constant(0.75));
    for (auto& f : cavity.faces) std::swap(f[0], f[1]);
    Triangles hollow = joined(cube_mesh(), cavity);
    const MeshHealth health = repair_orientation(hollow);
    CHECK(health.flipped_faces == 0);
    CHECK_FALSE(health.inside_out);
    const SurfaceDistance s(hollow);
    CHECK(s.signed_distance({0.5, 0.5, 0.5}) == doctest::Approx(0.25));
    CHECK(s.signed_distance({0.1, 0.5, 0.5}) == doctest::Approx(-0.1));
  }

  TEST_CASE("stl: the section of a 2D scene is measured in its plane") {
    const TemporaryFile file("section.stl");
    write_stl(file.path, cube_mesh({0, -0.1, 0}, {1, 0.1, 2}));
    Stl s;
    s.file.path = file.path;
    s.flat = true;
    s.prepare();
    CHECK(s.signed_distance({0.5, 0, 1}) == doctest::Approx(-0.5));  // not the 0.1 to the near side
    CHECK(s.signed_distance({4, 0, 6}) == doctest::Approx(5.0));
    CHECK(s.box().lo.y() == 0.0);
    s.translate = {0, 5, 0};
    CHECK_THROWS_AS(s.prepare(), IoError);
  }

  TEST_CASE("stl: the surfaces that come with the program are sound") {
    const std::string folder = SPHGEO_SOURCE_DIR "/share/assets/";
    const auto ball = read_shape("{type: stl, file: " + folder + "ball.stl}", 3);
    CHECK(ball.messages().empty());
    REQUIRE(ball.shape);
    CHECK(ball.shape->signed_distance({0, 0, 0}) == doctest::Approx(-0.1).epsilon(0.02));
    const auto wedge = read_shape("{type: stl, file: " + folder + "wedge.stl}", 3);
    CHECK(wedge.messages().empty());
    REQUIRE(wedge.shape);
    CHECK(wedge.shape->signed_distance({0.3, 0.1, 0.05}) == doctest::Approx(-0.05));
    CHECK(wedge.shape->signed_distance({0.2, 0.1, 0.2}) > 0.0);
  }

  TEST_CASE("stl: sizes beyond reason are refused, fine tolerances are not") {
    const TemporaryFile file("sizes.stl");
    write_stl(file.path, cube_mesh());
    Stl s;
    s.file.path = file.path;
    for (const double scale : {1e13, 1e-13, 1e300, 1e-300}) {
      s.scale = scale;
      CHECK_THROWS_WITH(s.prepare(), doctest::Contains("is 'scale' right?"));
    }
    s.scale = 1e11;
    s.weld_tolerance = 1e-300;  // cells this small could not be counted
    s.prepare();
    CHECK(s.signed_distance({5e10, 5e10, 5e10}) == doctest::Approx(-5e10));
  }

  TEST_CASE("stl: broken files are refused with their path") {
    const TemporaryFile file("broken.stl");
    CHECK_THROWS_AS(read_stl(file.path), IoError);
    write_stl(file.path, cube_mesh());
    std::filesystem::resize_file(file.path, 300);
    CHECK_THROWS_WITH(read_stl(file.path), doctest::Contains("truncated"));
    std::ofstream(file.path) << "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n";
    CHECK_THROWS_WITH(read_stl(file.path), doctest::Contains("line 4"));
    std::ofstream(file.path) << "solid x\nfacet\nvertex 0 0 0\nvertex 0 1 0\nendfacet\n";
    CHECK_THROWS_WITH(read_stl(file.path), doctest::Contains("2 corners"));
    std::ofstream(file.path)
        << "solid x\nfacet\nvertex 0 0 nan\nvertex 0 1 0\nvertex 1 0 0\nendfacet\n";
    CHECK_THROWS_WITH(read_stl(file.path), doctest::Contains("not finite"));
    std::ofstream(file.path) << "hello";
    CHECK_THROWS_WITH(read_stl(file.path), doctest::Contains("not an STL"));
    CHECK(read_shape("{type: stl, file: " + file.path + "}", 3).messages().find("shape.file") !=
          std::string::npos);
  }

  TEST_CASE("stl: capitals, ends of lines and headers of other programs") {
    const TemporaryFile text("foreign_text.stl"), binary("foreign_binary.stl");
    write_text_stl(text.path, cube_mesh());
    const Triangles cube = read_stl(text.path).mesh;
    std::ifstream in(text.path);
    std::string lower((std::istreambuf_iterator<char>(in)), {});
    const auto written = [&](std::string bytes, auto change) {
      for (char& c : bytes) c = change(c);
      std::ofstream(text.path, std::ios::binary | std::ios::trunc) << bytes;
      return read_stl(text.path);
    };
    CHECK(written(lower, [](char c) {
            return c >= 'a' && c <= 'z' ? char(c - 32) : c;
          }).mesh.faces == cube.faces);
    CHECK(written(lower, [](char c) { return c == '\n' ? '\r' : c; }).mesh.points == cube.points);

    write_stl(binary.path, cube);
    const auto with = [&](const char* header, std::uint32_t count, const std::string& tail) {
      std::fstream f(binary.path, std::ios::binary | std::ios::in | std::ios::out);
      f.write(header, 5);
      f.seekp(80);
      f.write(reinterpret_cast<const char*>(&count), 4);
      f.seekp(0, std::ios::end);
      f << tail;
    };
    with("other", 0, "");
    StlSurface s = read_stl(binary.path);
    CHECK(s.mesh.faces == cube.faces);
    REQUIRE(s.remarks.size() == 1);
    CHECK(s.remarks[0] == "its header counts 0 triangles; by its size it has 12");
    with("other", 0xffffffffU, "");
    CHECK(read_stl(binary.path).mesh.faces == cube.faces);
    with("solid", 12, "made by facet tools");
    s = read_stl(binary.path);
    CHECK(s.mesh.faces == cube.faces);
    CHECK(s.remarks.at(0) == "19 bytes behind its last triangle were left out");
    with("solid", 123456789, "");
    CHECK_THROWS_WITH(read_stl(binary.path),
                      doctest::Contains("123456789 triangles are more than"));
  }

  TEST_CASE("stl: faces that are there twice, and coordinates of a map, are said") {
    Triangles cube = cube_mesh();
    cube.faces.push_back({cube.faces[3][1], cube.faces[3][2], cube.faces[3][0]});
    CHECK(report(cube) == "shape.file: 1 face is there twice; one of each was left out\n");
    CHECK(report(cube_mesh(), ", translate: [556440, 5394932, 0]").find("coordinates of a map?") !=
          std::string::npos);
  }

  TEST_CASE("faces within the solid show parts that overlap or contain each other, and no cavity") {
    Triangles all;
    const auto add_cube = [&](const Vec3& lo, double side, bool cavity) {
      const auto first = static_cast<std::int32_t>(all.points.size());
      for (int k = 0; k < 8; ++k)
        all.points.push_back(lo + side * Vec3(k & 1, (k >> 1) & 1, (k >> 2) & 1));
      for (const auto& f : {std::array{0, 2, 1},
                            {1, 2, 3},
                            {4, 5, 6},
                            {5, 7, 6},
                            {0, 1, 4},
                            {1, 5, 4},
                            {2, 6, 3},
                            {3, 6, 7},
                            {0, 4, 2},
                            {2, 4, 6},
                            {1, 3, 5},
                            {3, 7, 5}})
        all.faces.push_back({first + f[0], first + f[cavity ? 2 : 1], first + f[cavity ? 1 : 2]});
    };
    add_cube({0, 0, 0}, 1, false);
    CHECK(enclosed_volume(all) == doctest::Approx(1));
    CHECK(SurfaceDistance(all).inner_faces() == 0);
    const Triangles one = all;
    add_cube({0.25, 0.25, 0.25}, 0.5, true);
    CHECK(SurfaceDistance(all).inner_faces() == 0);
    all = one;
    add_cube({0.25, 0.25, 0.25}, 0.5, false);
    CHECK(SurfaceDistance(all).inner_faces() == 0.5);
    all = one;
    add_cube({0.2, 0.2, 0.2}, 1, false);
    CHECK(SurfaceDistance(all).inner_faces() > 0.1);
    all = one;
    add_cube({2, 0, 0}, 1, false);
    CHECK(SurfaceDistance(all).inner_faces() == 0);
  }
}
