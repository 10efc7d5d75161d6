#include "report/page.h"

#include <fmt/format.h>

#include "core/atomic_file.h"
#include "report/markup.h"
#include "report/page_parts.h"

namespace sphgeo {

namespace {

constexpr std::size_t most_chart_bytes = 800'000;
/// Base64 makes four bytes of three.
constexpr double picture_share = 0.73;

std::string title_of(Runs runs) {
  std::string title = text_at(runs.front().summary, "/title");
  if (title.empty() && runs.front().model) title = runs.front().model->title;
  if (title.empty()) title = runs.front().label;
  for (const RunRecord& run : runs.subspan(1))
    if (text_at(run.summary, "/title") != title) return title + " and others";
  return title;
}

std::string embedded_summaries(Runs runs) {
  std::string out;
  for (std::size_t k = 0; k < runs.size(); ++k)
    out += fmt::format("<script type=\"application/json\" id=\"summary{}\">{}</script>\n",
                       k == 0 ? "" : "-" + std::to_string(k + 1),
                       script_escaped(runs[k].summary.dump(
                           -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  return out;
}

}  // namespace

std::string page_head(std::string_view title, std::string_view below, std::string_view body_class) {
  const std::string text = html_escaped(title);
  // The page loads nothing and runs no scripts, whatever a deck contains.
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
      "name=\"color-scheme\" content=\"light dark\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "style-src 'unsafe-inline'\">\n"
      "<meta name=\"generator\" "
      "content=\"sphgeo\">\n<title>{}</title>\n<style>\n{}</style>\n</head>\n<body{}>\n<main>\n"
      "<header>\n<h1>{}</h1>\n{}</header>\n",
      text, page_style, body_class.empty() ? "" : fmt::format(" class=\"{}\"", body_class), text,
      below);
}

std::string report_page(std::span<const RunRecord> runs) {
  std::string page = page_head(title_of(runs), header_html(runs), runs.size() > 1 ? "several" : "");
  page += section("Key figures", figures_html(runs));
  page += section("Expectations", expect_html(runs));
  std::string rest = section("Curves", curves_html(runs, most_chart_bytes));
  rest += section("Conservation", conservation_html(runs));
  rest += section("Computing time", time_html(runs));
  rest += section("Plan", plan_html(runs));
  rest += section("Deck", deck_html(runs));
  rest += "</main>\n" + embedded_summaries(runs) + "</body>\n</html>\n";

  PictureWishes wishes;
  if (runs.size() > 1) {
    wishes.times = runs.size() == 2 ? 5 : 4;
    wishes.width = runs.size() == 2 ? 720 : 560;
  }
  const std::size_t used = page.size() + rest.size() + 40'000;
  const std::size_t room = used < most_page_bytes ? most_page_bytes - used : 0;
  wishes.most_bytes = std::min(wishes.most_bytes,
                               static_cast<std::size_t>(picture_share * static_cast<double>(room)));
  if (wishes.most_bytes > 20'000)
    page += section("Scene", scene_html(runs, paint_runs(runs, wishes)));
  return page + rest;
}

std::size_t write_report(const std::vector<std::string>& folders, const std::string& path) {
  const std::string page = report_page(read_runs(folders));
  write_file_atomically(path, page);
  return page.size();
}

}  // namespace sphgeo
