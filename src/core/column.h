#pragma once
// Description of a column of numbers: of probes, of run.csv and of every CSV file that is written.

#include <optional>
#include <string>

namespace sphgeo {

/// One column: its name, its SI unit ("" or "1" when there is none) and a sentence for the legend.
struct Column {
  std::string name;
  std::string unit;
  std::string sentence;
  std::optional<double> along = {};  ///< of a profile: its place, from the start of the line, m

  /// "pressure [Pa]", or the bare name when there is no unit.
  std::string heading() const {
    return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
  }
};

}  // namespace sphgeo
