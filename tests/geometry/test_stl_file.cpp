// Which bytes are an STL, text or binary, and where a broken one is broken.

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "core/error.h"
#include "geometry/stl_file.h"

using namespace sphgeo;

namespace {

std::string stl_outcome(const std::string& bytes) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "sphgeo_test_stl_bytes").string();
  std::ofstream(path, std::ios::binary) << bytes;
  std::string said;
  try {
    said = std::to_string(read_stl(path).mesh.faces.size()) + " faces";
  } catch (const IoError& e) {
    said = e.what();
  }
  std::filesystem::remove(path);
  return said;
}

std::string face(const std::string& corner) {
  return "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex " + corner +
         "\nendloop\nendfacet\n";
}

bool said(const std::string& bytes, const std::string& what) {
  const std::string outcome = stl_outcome(bytes);
  CAPTURE(outcome);
  return outcome.find(what) != std::string::npos;
}

}  // namespace

TEST_SUITE("geometry") {
  TEST_CASE("stl: a text is one whatever stands before and behind its first word") {
    std::vector<std::string> begins{"solid a\n", "\xEF\xBB\xBFSOLID a\r\n"};
    begins.emplace_back(100, ' ').append("solid a\n");
    begins.emplace_back(5000, '\n').append("\t solid\n");
    begins.emplace_back("solid ").append(5000, 'x').append("\n");
    for (const std::string& begin : begins)
      CHECK(stl_outcome(begin + face("0 1 0") + "endsolid\n") == "1 faces");
  }

  TEST_CASE("stl: what is neither text nor binary is said to be none") {
    CHECK(said("", "not an STL file: it is empty"));
    CHECK(said(" \n", "not an STL file: it is empty"));
    CHECK(said("hello\n", "it begins with 'hello', not with 'solid'"));
    CHECK(said(fmt::format("ply\nformat ascii 1.0\n{:0>200}\n", 1), "it begins with 'ply'"));
  }

  TEST_CASE("stl: a bad corner of a text is said with its line") {
    CHECK(said("solid\n" + face("0 nan 0"), "line 6: a corner that is not finite"));
    CHECK(said("solid\n" + face("0 1 0") + face("0 0 -inf"), "line 13: a corner"));
    CHECK(said("solid\n" + face("0 1e-400 0"), "line 6: '1e-400' is too close to zero"));
    CHECK(said("solid\n" + face("0 1e400 0"), "line 6: '1e400' is too large for a number"));
  }
}
