#pragma once
// The report of runs: one HTML page that needs no other file.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "report/run_record.h"

namespace sphgeo {

/// A page stays below this many bytes, unless the summaries alone are larger.
inline constexpr std::size_t most_page_bytes = 3'000'000;

/// The page of one run, or of several side by side: status, results, pictures, cost, plans and
/// decks. Light and dark, for screens of any width, without scripts. Each summary.json stands in it
/// as <script type="application/json"> with the id "summary" (further runs: "summary-2" ...), and a
/// number that comes from there carries its JSON pointer as data-path. All text of decks is
/// escaped.
std::string report_page(std::span<const RunRecord> runs);

/// Reads the run folders and writes the page. Throws IoError when a folder holds no run or the page
/// cannot be written. Returns the size of the page in bytes.
std::size_t write_report(const std::vector<std::string>& folders, const std::string& path);

}  // namespace sphgeo
