#pragma once
// The sections of a report, each as HTML; and what sections are made of; for the pages of this
// program.

#include <span>
#include <string>
#include <string_view>

#include "report/run_record.h"
#include "report/scene_pictures.h"

namespace sphgeo {

using Runs = std::span<const RunRecord>;

/// The page up to its first section: the title (as text) and what stands below it (as HTML).
std::string page_head(std::string_view title, std::string_view below,
                      std::string_view body_class = {});
/// A table cell. `path` is the JSON pointer of a number that comes from summary.json of run `run`.
std::string cell(std::string_view html, std::string_view css_class = {}, std::string_view path = {},
                 std::size_t run = 0);
/// A number as a cell, right-aligned.
std::string number_cell(std::optional<double> value, std::string_view path = {},
                        std::size_t run = 0, int digits = 4);
/// A heading of a column over `span` columns.
std::string head_cell(std::string_view html, std::string_view css_class = {}, std::size_t span = 1);
/// A first row with the names of the runs, each over `each` columns, with so many columns before
/// and after; "" for one run.
std::string run_heads(Runs runs, std::size_t before, std::size_t each, std::size_t after = 0);
/// A number (as text) in other text, with where it comes from.
std::string traced(std::string_view text, std::string_view path, std::size_t run);
/// A name as a part of a JSON pointer.
std::string pointer_part(std::string_view name);
/// A line below, small and grey; "" for nothing.
std::string small_text(const std::string& html);
/// Rows in a box that scrolls by itself when the page is narrow.
std::string table(std::string_view css_class, std::string_view head, std::string_view rows);
/// A section with a heading; "" when there is nothing in it.
std::string section(std::string_view title, std::string_view html);
/// "3.99 s", "12 min 5 s".
std::string wall_text(double seconds);

std::string header_html(Runs runs);
std::string figures_html(Runs runs);
std::string expect_html(Runs runs);
std::string scene_html(Runs runs, const ScenePictures& pictures);
/// Charts of at most about `most_bytes`.
std::string curves_html(Runs runs, std::size_t most_bytes);
std::string conservation_html(Runs runs);
std::string ledger_html(Runs runs);
std::string guard_html(Runs runs);
std::string time_html(Runs runs);
std::string plan_html(Runs runs);
std::string deck_html(Runs runs);

/// The style sheet.
extern const std::string_view page_style;

}  // namespace sphgeo
