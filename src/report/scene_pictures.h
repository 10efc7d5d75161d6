#pragma once
// Pictures of runs, drawn from their frames.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "report/picture.h"
#include "report/run_record.h"

namespace sphgeo {

/// One painted moment.
struct Shot {
  double time = 0;  ///< s
  std::string png;
  int width = 0, height = 0;  ///< pixels; twice what the page shows, for fine screens
};

/// One quantity at several times, in one range of colours for all times and runs.
struct PictureRow {
  std::string title;  ///< "pressure of water"
  std::string unit;
  double low = 0, high = 1;
  bool clipped = false;  ///< some values lie outside of the range
  std::vector<std::vector<std::optional<Shot>>>
      shots;  ///< by run, then by time; empty where a run had ended
};

struct ScenePictures {
  std::vector<double> times;  ///< the moments wanted, s
  std::vector<PictureRow> rows;
  std::vector<std::string> problems;  ///< frames that could not be read

  std::size_t bytes() const;
};

struct PictureWishes {
  int times = 6;                       ///< moments, from the first frame to the last
  int width = 720;                     ///< of a picture at most, pixels
  std::size_t most_bytes = 1'500'000;  ///< of all PNG files together; they become smaller to fit
};

/// Paints the frames of runs: speed of everything that moves, pressure of water, plastic strain of
/// soil, von Mises stress of solids, as far as the frames hold them and they are not uniform.
ScenePictures paint_runs(std::span<const RunRecord> runs, const PictureWishes& wishes = {});

/// The spacing of particles (m), from the distances of some of them to their nearest neighbours; 0
/// when there are fewer than two.
double typical_spacing(std::span<const Vec3> positions);

/// Colour of a set without a quantity.
Color set_color(const std::string& set);

}  // namespace sphgeo
