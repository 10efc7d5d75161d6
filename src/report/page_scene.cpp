// The section of a report that is pictures.

#include <fmt/format.h>

#include "report/color_map.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

namespace {

std::string shot_html(const Shot& shot, const RunRecord& run, const std::string& what) {
  const std::string moment = is_relaxation(run) ? "step " + number_text(shot.time)
                                                : "t = " + number_text(shot.time) + "\u00a0s";
  return fmt::format(
      "<figure class=\"shot\"><img alt=\"{}\" width=\"{}\" height=\"{}\" "
      "src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
      html_escaped(what + ", " + moment), shot.width / 2, shot.height / 2, base64(shot.png),
      moment);
}

}  // namespace

std::string scene_html(Runs runs, const ScenePictures& pictures) {
  std::string out;
  for (const std::string& problem : pictures.problems)
    out += "<div class=\"message warn\"><p>" + html_escaped(problem) + "</p></div>\n";
  const bool several = runs.size() > 1;
  bool clipped = false;
  for (const PictureRow& row : pictures.rows) {
    const bool bar = row.high > row.low;
    clipped = clipped || row.clipped;
    out += fmt::format("<div class=\"quantity\"><h3>{}</h3>{}</div>\n", html_escaped(row.title),
                       bar ? color_bar_svg("", row.unit, row.low, row.high) : "");
    out += several ? fmt::format(
                         "<div class=\"box\"><div class=\"shots rows\" "
                         "style=\"--columns:{0};min-width:{1}px\">\n",
                         runs.size(), 150 * runs.size())
                   : std::string("<div class=\"shots\">\n");
    if (several)
      for (const RunRecord& run : runs)
        out += "<div class=\"column-title\">" + html_escaped(run.label) + "</div>\n";
    for (std::size_t t = 0; t < pictures.times.size(); ++t)
      for (std::size_t r = 0; r < runs.size(); ++r) {
        const auto& shot = row.shots[r][t];
        if (shot)
          out += shot_html(*shot, runs[r], row.title + (several ? ", " + runs[r].label : ""));
        else if (several) out += "<figure class=\"shot\"></figure>\n";
      }
    out += several ? "</div></div>\n" : "</div>\n";
  }
  if (clipped)
    out +=
        "<p class=\"quiet\">Colours have the same meaning at all times. Values beyond the ends of "
        "a bar have the colour of that end.</p>\n";
  return out;
}

}  // namespace sphgeo
