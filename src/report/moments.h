#pragma once
// The frames of a run at one time.

#include <cstddef>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "output/vtu_reader.h"
#include "report/run_record.h"

namespace sphgeo {

/// What is drawn of a surface: of the boundaries, or of the soil that water was relaxed in.
struct WallLines {
  std::vector<std::pair<Vec3, Vec3>> lines;
  Aabb box;
};

/// All sets of particles of a run at one moment, and the surfaces.
struct Moment {
  std::map<std::string, VtuFrame> sets;
  std::vector<const WallLines*> walls;  ///< owned by the reader
};

/// Reads moments. Small ones stay in memory; surfaces at rest, which have one file for all times,
/// are read once.
class MomentReader {
 public:
  /// Keeps moments up to so many numbers in all, with the fields that are `wanted`.
  MomentReader(std::size_t most_values, std::function<bool(const std::string&)> wanted)
      : most_values_(most_values), wanted_(std::move(wanted)) {}

  /// The frames with exactly this time (s); `scratch` holds them when they are too large to be
  /// kept. The record must outlive the reader. Frames that cannot be read are left out, and named
  /// in problems().
  const Moment& operator()(const RunRecord& run, double time, Moment& scratch);

  const std::set<std::string>& problems() const { return problems_; }

 private:
  Moment load(const RunRecord& run, double time);

  std::size_t most_values_;
  std::function<bool(const std::string&)> wanted_;
  std::map<std::pair<const RunRecord*, double>, Moment> kept_;
  std::size_t values_ = 0;                  ///< numbers in kept_
  std::map<std::string, WallLines> walls_;  ///< by file
  std::set<std::string> problems_;
};

}  // namespace sphgeo
