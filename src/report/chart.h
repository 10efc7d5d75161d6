#pragma once
// Line charts as SVG, for pages that are light or dark.

#include <optional>
#include <string>
#include <vector>

#include "report/axis.h"

namespace sphgeo {

/// One curve of a chart. A point that is not finite (or not positive on a logarithmic axis) is a
/// gap.
struct ChartCurve {
  std::string name;          ///< in the legend; empty: not there
  std::vector<double> x, y;  ///< equally many
  bool line = true;
  bool markers = false;
  bool dashed = false;
  bool emphasised = false;               ///< a heavy line, large filled markers
  bool neutral = false;                  ///< in the colour of the text: references, fronts
  std::optional<int> color = {};         ///< number in the palette; empty: the next one
  std::vector<std::string> labels = {};  ///< beside the points; none, or one a point ("" = none)
};

struct Chart {
  std::string title;  ///< above the chart; empty: none
  ChartAxis x, y;
  std::vector<ChartCurve> curves;
  double width = 480;   ///< of the drawing, in units of a 12.5 unit font
  double height = 300;  ///< with axes, without the legend
};

/// The chart as one <svg> element that scales with its box, uses the colour of the text around it,
/// and the palette of CSS variables --curve-0 ... --curve-7 where a page defines them. Long curves
/// are thinned to what can be seen. A chart without a finite point says so. Throws
/// std::invalid_argument when x, y and labels of a curve differ in length.
std::string chart_svg(const Chart& chart);

}  // namespace sphgeo
