// What the tables of a report are made of.

#include <fmt/format.h>

#include "output/progress.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

std::string pointer_part(std::string_view name) {
  std::string out;
  for (const char c : name) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string traced(std::string_view text, std::string_view path, std::size_t run) {
  return fmt::format("<span data-path=\"{}\"{}>{}</span>", html_escaped(path),
                     run == 0 ? "" : fmt::format(" data-run=\"{}\"", run + 1), html_escaped(text));
}

std::string small_text(const std::string& html) {
  return html.empty() ? "" : "<small>" + html + "</small>";
}

std::string wall_text(double seconds) {
  if (seconds < 100) return number_text(seconds, 3) + "\u00a0s";
  return duration_text(seconds);
}

std::string cell(std::string_view html, std::string_view css_class, std::string_view path,
                 std::size_t run) {
  return fmt::format(
      "<td{}{}{}>{}</td>", css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
      path.empty() ? "" : fmt::format(" data-path=\"{}\"", html_escaped(path)),
      run == 0 || path.empty() ? "" : fmt::format(" data-run=\"{}\"", run + 1), html);
}

std::string number_cell(std::optional<double> value, std::string_view path, std::size_t run,
                        int digits) {
  return cell(value ? number_text(*value, digits) : "–", "n", value ? path : "", run);
}

std::string head_cell(std::string_view text, std::string_view css_class, std::size_t span) {
  return fmt::format("<th{}{}>{}</th>",
                     css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
                     span > 1 ? fmt::format(" colspan=\"{}\"", span) : "", text);
}

std::string run_heads(Runs runs, std::size_t before, std::size_t each, std::size_t after) {
  if (runs.size() < 2) return {};
  std::string out =
      "<tr>" + (before > 0 ? fmt::format("<th colspan=\"{}\"></th>", before) : std::string());
  for (const RunRecord& run : runs) out += head_cell(html_escaped(run.label), "run", each);
  return out +
         (after > 0 ? fmt::format("<th class=\"run\" colspan=\"{}\"></th>", after)
                    : std::string()) +
         "</tr>";
}

std::string table(std::string_view css_class, std::string_view head, std::string_view rows) {
  return fmt::format(
      "<div class=\"box\"><table{}>\n<thead>{}</thead>\n<tbody>\n{}</tbody>\n</table></div>\n",
      css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class), head, rows);
}

std::string section(std::string_view title, std::string_view html) {
  return html.empty() ? "" : fmt::format("<section>\n<h2>{}</h2>\n{}</section>\n", title, html);
}

}  // namespace sphgeo
