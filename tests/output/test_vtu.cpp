#include <doctest/doctest.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numeric>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/parallel.h"
#include "output/vtu.h"
#include "temporary_folder.h"

using namespace sphgeo;

namespace {

/// A minimal reader of appended arrays, written apart from the writer.
class Reader {
 public:
  explicit Reader(const std::string& path) : text_(read_file(path)) {
    compressed_ = text_.find("vtkZLibDataCompressor") != std::string::npos;
    data_ = text_.find("_", text_.find("<AppendedData encoding=\"raw\">")) + 1;
  }
  const std::string& text() const { return text_; }

  /// The raw bytes of the array of that name.
  std::string bytes(const std::string& name) const {
    const auto element = text_.find("Name=\"" + name + "\"");
    REQUIRE(element != std::string::npos);
    std::size_t at =
        data_ + std::strtoull(&text_[text_.find("offset=\"", element) + 8], nullptr, 10);
    const std::uint64_t first = u64(at);
    if (!compressed_) return text_.substr(at + 8, first);
    const std::uint64_t size = u64(at + 8), last = u64(at + 16);
    std::size_t body = at + 24 + 8 * first;
    std::string out;
    for (std::uint64_t b = 0; b < first; ++b) {
      uLongf length = b + 1 == first && last != 0 ? last : size;
      std::string block(length, '\0');
      const std::uint64_t packed = u64(at + 24 + 8 * b);
      REQUIRE(uncompress(reinterpret_cast<Bytef*>(block.data()), &length,
                         reinterpret_cast<const Bytef*>(&text_[body]), packed) == Z_OK);
      REQUIRE(length == block.size());
      body += packed;
      out += block;
    }
    end_ = std::max(end_, body);
    return out;
  }

  template <class T>
  std::vector<T> values(const std::string& name) const {
    const std::string raw = bytes(name);
    std::vector<T> out(raw.size() / sizeof(T));
    if (!out.empty()) std::memcpy(out.data(), raw.data(), raw.size());
    return out;
  }
  /// Whether the arrays read so far reach exactly to the end of the appended data.
  bool complete() const { return text_.substr(end_) == "\n  </AppendedData>\n</VTKFile>\n"; }

 private:
  std::uint64_t u64(std::size_t at) const {
    std::uint64_t v = 0;
    std::memcpy(&v, &text_[at], 8);
    return v;
  }

  std::string text_;
  std::size_t data_ = 0;
  bool compressed_ = false;
  mutable std::size_t end_ = 0;
};

struct Cloud {
  std::vector<Vec3> points;
  std::vector<double> velocity, pressure;
  std::vector<std::uint64_t> id;
  std::vector<std::int32_t> body;

  explicit Cloud(std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const auto x = static_cast<double>(i);
      points.emplace_back(0.1 * x, 0, -x);
      for (int k = 0; k < 3; ++k) velocity.push_back(x + 0.25 * k);
      pressure.push_back(i == 1 ? std::nan("") : 1000 / (x + 1));
      id.push_back((std::uint64_t{1} << 40) + 7 * i);
      body.push_back(-static_cast<std::int32_t>(i % 3));
    }
  }
  std::vector<VtuField> fields() const {
    return {{"velocity", "m/s", 3, velocity},
            {"pressure", "Pa", 1, pressure},
            {"id", "", 1, id},
            {"part <&>", "1", 1, body}};
  }
};

}  // namespace

TEST_SUITE("output") {
  TEST_CASE("a frame reads back, packed or not, in one or many blocks") {
    const test::TemporaryFolder folder;
    for (const std::size_t n :
         {std::size_t{0}, std::size_t{5}, std::size_t{16380}, std::size_t{40001}})
      for (const bool compress : {false, true})
        for (const VtuPrecision precision : {VtuPrecision::float32, VtuPrecision::float64}) {
          CAPTURE(n);
          CAPTURE(compress);
          const Cloud cloud(n);
          write_vtu(folder / "a.vtu", cloud.points, cloud.fields(),
                    {precision, compress, 0.1 + 0.2});
          const Reader in(folder / "a.vtu");
          std::vector<std::int32_t> count(n);
          std::iota(count.begin(), count.end(), 0);
          CHECK(in.values<std::int32_t>("connectivity") == count);
          for (std::int32_t& c : count) ++c;
          CHECK(in.values<std::int32_t>("offsets") == count);
          CHECK(in.values<std::uint8_t>("types") == std::vector<std::uint8_t>(n, 1));
          CHECK(in.values<std::uint64_t>("id") == cloud.id);
          CHECK(in.values<std::int32_t>("part &lt;&amp;&gt;") == cloud.body);
          if (precision == VtuPrecision::float64) {
            CHECK(in.values<double>("velocity") == cloud.velocity);
            const auto points = in.values<double>("Points");
            REQUIRE(points.size() == 3 * n);
            for (std::size_t i = 0; i < n; ++i) REQUIRE(points[3 * i] == cloud.points[i].x());
          } else {
            const auto p = in.values<float>("pressure");
            REQUIRE(p.size() == n);
            if (n > 0) CHECK(std::isnan(p[1]));
            for (std::size_t i = 2; i < n; ++i)
              REQUIRE(p[i] == static_cast<float>(cloud.pressure[i]));
            const auto points = in.values<float>("Points");
            REQUIRE(points.size() == 3 * n);
            for (std::size_t i = 0; i < n; ++i)
              REQUIRE(points[3 * i + 2] == static_cast<float>(cloud.points[i].z()));
          }
          if (compress) CHECK(in.complete());
          CHECK(in.text().find("Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
                               "0.30000000000000004<") != std::string::npos);
          CHECK(in.text().find(">m/s</InformationKey>") != std::string::npos);
        }
    CHECK(folder.entries() == 1);
  }

  TEST_CASE("packing the integers pays, and the bytes are the same each time") {
    const test::TemporaryFolder folder;
    const Cloud cloud(40001);
    write_vtu(folder / "raw.vtu", cloud.points, cloud.fields(), {VtuPrecision::float32, false, {}});
    write_vtu(folder / "a.vtu", cloud.points, cloud.fields());
    write_vtu(folder / "b.vtu",
              VtuPoints(40001, [&](Index i) { return cloud.points[static_cast<std::size_t>(i)]; }),
              cloud.fields());
    CHECK(read_file(folder / "a.vtu") == read_file(folder / "b.vtu"));
    CHECK(static_cast<double>(std::filesystem::file_size(folder / "a.vtu")) <
          0.8 * static_cast<double>(std::filesystem::file_size(folder / "raw.vtu")));
    CHECK(read_file(folder / "a.vtu").find("TimeValue") == std::string::npos);
  }

  TEST_CASE("a frame is the same bytes with any number of threads") {
    const test::TemporaryFolder folder;
    const Cloud cloud(40001);
    const int before = threads();
    for (const int n : {1, 2, 3}) {
      set_threads(n);
      write_vtu(folder / std::to_string(n), cloud.points, cloud.fields());
      CHECK(read_file(folder / std::to_string(n)) == read_file(folder / "1"));
    }
    set_threads(before);
  }

  TEST_CASE("a surface of triangles and one of lines") {
    const test::TemporaryFolder folder;
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<Index> corners = {0, 1, 2, 0, 2, 3};
    const std::vector<double> height = {0, 0, 0, 1}, area = {0.5, 0.75};
    write_vtu_mesh(folder / "t.vtu", points, 3, corners, {{"height", "m", 1, height}},
                   {{"area", "m2", 1, area}});
    const Reader t(folder / "t.vtu");
    CHECK(t.values<std::int32_t>("connectivity") == std::vector<std::int32_t>{0, 1, 2, 0, 2, 3});
    CHECK(t.values<std::int32_t>("offsets") == std::vector<std::int32_t>{3, 6});
    CHECK(t.values<std::uint8_t>("types") == std::vector<std::uint8_t>{5, 5});
    CHECK(t.values<float>("area") == std::vector<float>{0.5f, 0.75f});
    write_vtu_mesh(folder / "l.vtu", points, 2, corners, {}, {});
    CHECK(Reader(folder / "l.vtu").values<std::uint8_t>("types") ==
          std::vector<std::uint8_t>{3, 3, 3});

    CHECK_THROWS_AS(write_vtu_mesh(folder / "x.vtu", points, 4, corners, {}, {}),
                    std::invalid_argument);
    const std::vector<Index> wrong = {0, 1, 4};
    CHECK_THROWS_AS(write_vtu_mesh(folder / "x.vtu", points, 3, wrong, {}, {}),
                    std::invalid_argument);
    CHECK_THROWS_AS(write_vtu(folder / "x.vtu", points, {{"p", "", 3, area}}),
                    std::invalid_argument);
    CHECK(folder.entries() == 2);
  }

  TEST_CASE("a frame that cannot be written is an input-output failure") {
    const Cloud cloud(10);
    CHECK_THROWS_WITH_AS(write_vtu("/nowhere/a.vtu", cloud.points, cloud.fields()),
                         "/nowhere/a.vtu: cannot create the file: No such file or directory",
                         IoError);
    CHECK_THROWS_AS(write_vtu("/dev/full", cloud.points, cloud.fields()), IoError);
  }

  // For tests/tools/read_vtu.py: VTK's own reader judges these files when it is installed.
  TEST_CASE("frames for VTK's own reader") {
    const char* target = std::getenv("SPHGEO_VTU_SAMPLES");
    const test::TemporaryFolder scratch;
    const std::string folder = target != nullptr ? target : scratch.path();
    for (const int n : {0, 5, 40001})
      for (const bool compress : {false, true}) {
        const Cloud cloud(static_cast<std::size_t>(n));
        const std::string name =
            folder + "/cloud_" + std::to_string(n) + (compress ? "_packed" : "_raw");
        write_vtu(name + ".vtu", cloud.points, cloud.fields(),
                  {compress ? VtuPrecision::float32 : VtuPrecision::float64, compress, 0.125});
        CHECK(std::filesystem::exists(name + ".vtu"));
      }
    const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const std::vector<Index> corners = {0, 1, 2, 0, 2, 3};
    const std::vector<double> area = {0.5, 0.5};
    write_vtu_mesh(folder + "/mesh_triangles.vtu", points, 3, corners, {},
                   {{"area", "m2", 1, area}});
    write_vtu_mesh(folder + "/mesh_lines.vtu", points, 2, corners, {}, {});
  }
}
