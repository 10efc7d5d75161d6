#pragma once
// The runs of a study.

#include <string>
#include <utility>
#include <vector>

namespace sphgeo {

/// One key of the deck and the values that it takes in turn.
struct Variation {
  std::string key;  ///< as for --set: a path, or the name of a variable
  std::vector<std::string> values;
};

/// Reads "resolution=0.04,0.02"; commas within brackets and quotes belong to a value. Throws Error
/// (usage).
Variation parse_variation(const std::string& text);

/// A key and its value, as written.
using Setting = std::pair<std::string, std::string>;

/// "resolution=0.04 viscosity=0".
std::string settings_text(const std::vector<Setting>& settings);

/// Runs along one key, with all other keys fixed.
struct StudyCurve {
  std::string key;
  std::vector<Setting> others;    ///< settings that all its runs share
  std::vector<std::size_t> runs;  ///< in the order of the key's values
};

struct StudyDesign {
  std::vector<std::vector<Setting>> runs;  ///< each run's settings, different from each other
  std::vector<StudyCurve> curves;
};

/// Each key varied by itself, the others as the deck has them: one curve a key.
StudyDesign one_at_a_time(const std::vector<Variation>& variations);

/// All combinations; curves run along the first key, one for each combination of the others.
StudyDesign all_combinations(const std::vector<Variation>& variations);

}  // namespace sphgeo
