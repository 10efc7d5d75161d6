#include <doctest/doctest.h>

#include <cmath>
#include <fstream>

#include "core/atomic_file.h"
#include "core/error.h"
#include "output/vtu.h"
#include "output/vtu_reader.h"
#include "temporary_folder.h"

using namespace sphgeo;

namespace {

struct Sample {
  std::vector<Vec3> points;
  std::vector<double> velocity, pressure;
  std::vector<std::uint64_t> id;
  std::vector<std::int32_t> part;

  explicit Sample(int n) {
    for (int i = 0; i < n; ++i) {
      points.emplace_back(0.1 * i, std::sin(i), -1.0 / (1 + i));
      pressure.push_back(1e4 / 3 * i);
      for (int k = 0; k < 3; ++k) velocity.push_back(i + 0.25 * k);
      id.push_back(static_cast<std::uint64_t>(7 * i));
      part.push_back(-i % 3);
    }
  }
  std::vector<VtuField> fields() const {
    return {{"id", "", 1, std::span<const std::uint64_t>(id)},
            {"velocity", "m/s", 3, std::span<const double>(velocity)},
            {"a<&>\"b", "Pa", 1, std::span<const double>(pressure)},
            {"part", "", 1, std::span<const std::int32_t>(part)}};
  }
};

/// The file with other bytes at a place found by a text in it.
std::string replaced(std::string file, const std::string& what, const std::string& by) {
  const auto at = file.find(what);
  REQUIRE(at != std::string::npos);
  return file.replace(at, what.size(), by);
}

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("what the writer of frames wrote comes back") {
    const test::TemporaryFolder folder;
    for (const int n : {0, 1, 5000, 8190, 20000})
      for (const bool compress : {true, false}) {
        const Sample s(n);
        VtuOptions options;
        options.precision = VtuPrecision::float64;
        options.compress = compress;
        options.time = 0.1 + 0.2;
        write_vtu(folder / "a.vtu", s.points, s.fields(), options);
        const VtuFrame frame = read_vtu(folder / "a.vtu");
        CHECK(frame.time == 0.1 + 0.2);
        CHECK(frame.points == s.points);
        CHECK(frame.corners_per_cell == 1);
        CHECK(frame.corners.empty());
        REQUIRE(frame.point_fields.size() == 4);
        REQUIRE(frame.find("velocity"));
        CHECK(frame.find("velocity")->values == s.velocity);
        CHECK(frame.find("velocity")->unit == "m/s");
        CHECK(frame.find("velocity")->components == 3);
        REQUIRE(frame.find("a<&>\"b"));
        CHECK(frame.find("a<&>\"b")->values == s.pressure);
        CHECK(frame.find("id")->values == std::vector<double>(s.id.begin(), s.id.end()));
        CHECK(frame.find("part")->values == std::vector<double>(s.part.begin(), s.part.end()));
        CHECK(frame.find("nothing") == nullptr);
        if (n > 2)
          CHECK(frame.find("velocity")->magnitude(2) ==
                doctest::Approx(std::sqrt(2 * 2 + 2.25 * 2.25 + 2.5 * 2.5)));
      }
  }

  TEST_CASE("single precision, chosen fields and the names alone") {
    const test::TemporaryFolder folder;
    const Sample s(100);
    write_vtu(folder / "a.vtu", s.points, s.fields());
    VtuReading only;
    only.wanted = [](const std::string& name) { return name == "velocity"; };
    const VtuFrame frame = read_vtu(folder / "a.vtu", only);
    CHECK(!frame.time);
    REQUIRE(frame.point_fields.size() == 1);
    for (std::size_t i = 0; i < s.points.size(); ++i)
      CHECK(frame.points[i].y() == static_cast<double>(static_cast<float>(s.points[i].y())));
    const auto fields = vtu_fields(folder / "a.vtu");
    REQUIRE(fields.size() == 4);
    CHECK(fields[1].name == "velocity");
    CHECK(fields[1].unit == "m/s");
    CHECK(fields[1].values.empty());
  }

  TEST_CASE("meshes come back with their corners") {
    const test::TemporaryFolder folder;
    const Sample s(4);
    const std::vector<Index> corners{0, 1, 2, 1, 2, 3};
    const std::vector<std::int32_t> part{4, 5};
    write_vtu_mesh(folder / "a.vtu", s.points, 3, corners, {},
                   {{"part", "", 1, std::span<const std::int32_t>(part)}});
    const VtuFrame frame = read_vtu(folder / "a.vtu");
    CHECK(frame.corners_per_cell == 3);
    CHECK(frame.corners == corners);
    REQUIRE(frame.cell_fields.size() == 1);
    CHECK(frame.cell_fields[0].values == std::vector<double>{4, 5});
  }

  TEST_CASE("foreign and damaged frames are refused with their path") {
    const test::TemporaryFolder folder;
    const std::string path = folder / "a.vtu";
    const Sample s(3000);
    write_vtu(path, s.points, s.fields());
    const std::string good = read_file(path);
    const auto refused = [&](const std::string& text, const std::string& because) {
      write_file_atomically(path, text);
      try {
        read_vtu(path);
        FAIL("was read: " << because);
      } catch (const IoError& e) {
        CHECK_MESSAGE(std::string(e.what()).starts_with(path), e.what());
        CHECK_MESSAGE(std::string(e.what()).find(because) != std::string::npos, e.what());
      }
    };
    refused("", "not a frame of sphgeo");
    refused("<?xml version=\"1.0\"?>\n<VTKFile/>", "not a frame of sphgeo");
    refused(replaced(good, "LittleEndian", "BigEndian"), "byte order");
    refused(replaced(good, "UnstructuredGrid", "PolyData"), "not an unstructured grid");
    refused(replaced(good, "ZLib", "LZ4"), "compressor");
    refused(replaced(good, "NumberOfPoints=\"3000\"", "NumberOfPoints=\"3001\""), "not as long");
    refused(replaced(good, "NumberOfPoints=\"3000\"", "NumberOfPoints=\"99999999999999999\""),
            "too much memory");
    refused(replaced(good, "NumberOfPoints=\"3000\"", "NumberOfPoints=\"3e3\""), "not a number");
    refused(replaced(good, "NumberOfComponents=\"3\"", "NumberOfComponents=\"0\""), "components");
    refused(replaced(good, "offset=\"0\"", "offset=\"99999999\""), "beyond the end");
    refused(
        replaced(good, "type=\"Float32\" Name=\"velocity\"", "type=\"Float16\" Name=\"velocity\""),
        "type");
    refused(good.substr(0, good.size() / 2), "damaged");
    std::string flipped = good;
    flipped[good.find("\n_") + 60] ^= 0x10;  // in the packed ids
    refused(flipped, "array 'id'");
    CHECK_THROWS_AS(read_vtu(folder / "missing.vtu"), IoError);
    write_file_atomically(path, good);
    VtuReading small;
    small.most_bytes = 1000;
    CHECK_THROWS_AS(read_vtu(path, small), IoError);
  }

  TEST_CASE("no flipped byte of a frame does more than an error") {
    const test::TemporaryFolder folder;
    const Sample s(40);
    write_vtu(folder / "a.vtu", s.points, s.fields());
    const std::string good = read_file(folder / "a.vtu");
    int refused = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ 0x11);
      std::ofstream(folder / "b.vtu", std::ios::binary) << bad;  // no wait for the disk each time
      try {
        read_vtu(folder / "b.vtu");
      } catch (const IoError&) {
        ++refused;
      }
    }
    CHECK(refused > 500);
  }
}
