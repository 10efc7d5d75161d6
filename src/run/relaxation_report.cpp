#include "run/relaxation_report.h"

#include <fmt/format.h>

#include <cmath>

namespace sphgeo {
namespace {

std::vector<Column> columns() {
  return {
      {"density_spread", "",
       "standard deviation of the number density over its mean, of free particles deeper than "
       "their kernel support"},
      {"mass_error", "", "particles too many for the water in pores and clear; negative: too few"},
      {"density_mean", "", "mean of the same number densities; 1 is the target"},
      {"density_low", "", "smallest of them"},
      {"density_high", "", "largest of them"},
      {"mean_move", "", "mean displacement of the step over the target spacing"},
      {"largest_move", "", "largest displacement of the step over the target spacing"}};
}

}  // namespace

Series relaxation_series(const Model& model, const PoreWater& water) {
  Series out(relaxation_probe, columns());
  const double error = water.mass_error(std::pow(model.resolution, model.dimension));
  double step = 0;
  for (const RelaxationStep& s : water.history)
    out.add(step++, std::vector<double>{s.density_spread, error, s.density_mean, s.density_low,
                                        s.density_high, s.mean_move, s.largest_move});
  if (water.history.empty()) out.add(0, std::vector<double>{0, error, 1, 1, 1, 0, 0});
  return out;
}

void write_relaxation(const std::string& path, const Series& history) {
  std::vector<Column> all{{"step", "", "of the relaxation; 0 is the start"}};
  all.insert(all.end(), history.columns().begin(), history.columns().end());
  CsvWriter csv(path, history.name(), all);
  std::vector<double> row(all.size());
  for (std::size_t k = 0; k < history.times().size(); ++k) {
    row[0] = history.times()[k];
    for (std::size_t c = 1; c < row.size(); ++c) row[c] = history.column(c - 1)[k];
    csv.row(row);
  }
  csv.flush();
}

std::string relaxation_line(const Model& model, const PoreWater& water) {
  std::string how;
  if (water.from_file) how = "from " + model.relaxation.file->path;
  else if (water.history.size() < 2) how = "accepted, not moved";
  else
    how = fmt::format("{} of them moved in {} steps, spread {:.2g} % to {:.2g} %, {:.2g} s",
                      water.moved, water.history.size() - 1,
                      100 * water.history.front().density_spread,
                      100 * water.history.back().density_spread, water.seconds);
  return fmt::format("water in soil: {} particles, {}", water.accepted, how);
}

std::vector<Expect> relaxation_expects(const Model& model, bool about_relaxation) {
  std::vector<Expect> out;
  for (const Expect& e : model.expect)
    if ((e.probe.substr(0, e.probe.find('.')) == relaxation_probe) == about_relaxation)
      out.push_back(e);
  return out;
}

}  // namespace sphgeo
