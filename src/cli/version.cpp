// What this build is: its version, and for `--version` the information for bug reports.

#include <H5public.h>
#include <fmt/format.h>
#include <muParser.h>
#include <png.h>
#include <zlib.h>
#include <CLI/Version.hpp>

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "core/parallel.h"
#include "core/version.h"
#include "sph/lanes.h"

namespace sphgeo {
namespace {

std::string compiler() {
#if defined(__clang__)
  return "Clang " __clang_version__;
#else
  return "GCC " __VERSION__;
#endif
}

std::string muparser() {
  const std::string text = mu::Parser().GetVersion(mu::pviBRIEF);  // "2.3.3 (Release)"
  return text.substr(0, text.find(' '));
}

std::string hdf5() {
  unsigned major = 0, minor = 0, release = 0;
  H5get_libversion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

}  // namespace

std::string version_text() {
  // Versions of libraries are those loaded where they can be queried, else those of the build.
  return fmt::format(
      "sphgeo {}\n"
      "commit     {}\n"
      "compiler   {}, {}, for {}\n"
      "vectors    {} bits: {} numbers in single, {} in double precision\n"
      "threads    up to {}; OpenMP {} for vectors\n"
      "libraries  yaml-cpp {}, muparser {}, nlohmann-json {}.{}.{}, HDF5 {}, zlib {}, libpng {}, "
      "fmt {}.{}.{}, CLI11 {}, Eigen {}.{}.{}\n",
      version(), SPHGEO_COMMIT, compiler(), SPHGEO_BUILD_TYPE, SPHGEO_ARCH, 8 * lane_bytes,
      native_width<float>, native_width<double>, threads(), _OPENMP, SPHGEO_YAML_CPP, muparser(),
      NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH, hdf5(),
      zlibVersion(), png_get_libpng_ver(nullptr), FMT_VERSION / 10000, FMT_VERSION / 100 % 100,
      FMT_VERSION % 100, CLI11_VERSION, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
      EIGEN_MINOR_VERSION);
}

}  // namespace sphgeo
