#include "output/time_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace sphgeo {

std::vector<TimeRow> with_rest(std::vector<TimeRow> rows, double wall_s) {
  std::erase_if(rows, [](const TimeRow& r) { return r.calls == 0 && r.seconds == 0; });
  std::sort(rows.begin(), rows.end(), [](const TimeRow& a, const TimeRow& b) {
    return a.seconds != b.seconds ? a.seconds > b.seconds : a.name < b.name;
  });
  double sum = 0;
  for (const TimeRow& r : rows) sum += r.seconds;
  // The rest may be negative when rows were measured twice; it is shown as it is.
  rows.push_back({"rest", 1, wall_s - sum, 0});
  for (TimeRow& r : rows) r.share = wall_s > 0 ? r.seconds / wall_s : 0;
  return rows;
}

std::string render_time_table(const std::vector<TimeRow>& rows) {
  std::size_t width = 6;
  for (const TimeRow& r : rows) width = std::max(width, r.name.size());
  std::string out = fmt::format("  {:<{}}  {:>10}  {:>10}  {:>7}\n", "effect", width, "calls",
                                "seconds", "share");
  TimeRow total{"total"};
  for (const TimeRow& r : rows) {
    const std::string calls = r.name == "rest" ? "" : std::to_string(r.calls);
    out += fmt::format("  {:<{}}  {:>10}  {:>10.3f}  {:>5.1f} %", r.name, width, calls, r.seconds,
                       100 * r.share);
    // The particles that an effect skips are part of its cost.
    if (!r.walked_set.empty())
      out += fmt::format("  {:.3g} % of {}", 100 * r.walked_share, r.walked_set);
    out += '\n';
    total.seconds += r.seconds;
    total.share += r.share;
  }
  out += fmt::format("  {:<{}}  {:>10}  {:>10.3f}  {:>5.1f} %\n", total.name, width, "",
                     total.seconds, 100 * total.share);
  return out;
}

}  // namespace sphgeo
