#include "output/time_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace sphgeo {

std::vector<TimeRow> with_rest(std::vector<TimeRow> rows, const Spent& whole) {
  std::erase_if(rows, [](const TimeRow& r) { return r.calls == 0 && r.spent.seconds == 0; });
  std::sort(rows.begin(), rows.end(), [](const TimeRow& a, const TimeRow& b) {
    return a.spent.seconds != b.spent.seconds ? a.spent.seconds > b.spent.seconds : a.name < b.name;
  });
  // The rest may be negative when rows were measured twice; it is shown as it is.
  Spent rest = whole;
  for (const TimeRow& r : rows) {
    rest.seconds -= r.spent.seconds;
    rest.processor -= r.spent.processor;
    rest.offered -= r.spent.offered;
  }
  rows.push_back({"rest", 1, rest});
  for (TimeRow& r : rows) {
    r.share = whole.seconds > 0 ? r.spent.seconds / whole.seconds : 0;
    r.busy = r.spent.busy();
  }
  return rows;
}

std::string render_time_table(const std::vector<TimeRow>& rows) {
  std::size_t width = 6;
  for (const TimeRow& r : rows) width = std::max(width, r.name.size());
  std::string out = fmt::format("  {:<{}}  {:>10}  {:>10}  {:>7}  {:>7}\n", "effect", width,
                                "calls", "seconds", "share", "busy");
  const auto line = [&](const TimeRow& r, const std::string& calls) {
    return fmt::format("  {:<{}}  {:>10}  {:>10.3f}  {:>5.1f} %  {:>5.1f} %", r.name, width, calls,
                       r.spent.seconds, 100 * r.share, 100 * r.busy);
  };
  TimeRow total{"total"};
  for (const TimeRow& r : rows) {
    out += line(r, r.name == "rest" ? "" : std::to_string(r.calls));
    // The particles that an effect skips are part of its cost.
    if (!r.walked_set.empty())
      out += fmt::format("  {:.3g} % of {}", 100 * r.walked_share, r.walked_set);
    out += '\n';
    total.spent += r.spent;
    total.share += r.share;
  }
  total.busy = total.spent.busy();
  return out + line(total, "") + '\n';
}

}  // namespace sphgeo
