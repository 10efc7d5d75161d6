#include "scene/output_check.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/text.h"
#include "deck/reference_curve.h"
#include "particles/fields.h"
#include "probes/probe.h"

namespace sphgeo {
namespace {

// The column that a claim names, "front.x" or "front"; nothing, and an error, without it.
std::optional<Column> column_of(const Model& model, std::size_t claim, Diagnostics& found) {
  const std::string& source = model.expect[claim].probe;
  const auto dot = source.find('.');
  const std::string name = source.substr(0, dot);
  for (const auto& spec : model.probes) {
    if (spec->name != name) continue;
    const std::vector<Column> columns = dynamic_cast<const Probe&>(*spec).columns(model);
    if (model.expect[claim].reduce == "profile" &&
        (dot != std::string::npos || !columns.front().along)) {
      const std::string path = fmt::format("expect[{}].probe", claim);
      found.error("E155", model.place_of(path), path, fmt::format("'{}' is not a profile", source),
                  "reduce: profile needs the name of a probe of type surface_profile");
      return {};
    }
    if (dot == std::string::npos) return columns.front();
    const std::string wanted = source.substr(dot + 1);
    std::vector<std::string> names;
    for (const Column& c : columns) {
      if (c.name == wanted) return c;
      names.push_back(c.name);
    }
    const std::string path = fmt::format("expect[{}].probe", claim);
    found.error("E150", model.place_of(path), path,
                fmt::format("probe '{}' has no column '{}'", name, wanted),
                suggestion(wanted, names, "its columns"));
  }
  return {};
}

void check_claims(const Model& model, Diagnostics& found) {
  for (std::size_t k = 0; k < model.expect.size(); ++k) {
    const std::optional<Column> column = column_of(model, k, found);
    if (!column || !model.expect[k].reference_csv) continue;
    try {
      read_reference(model.expect[k], column->unit);
    } catch (const Error& e) {
      const std::string path = fmt::format("expect[{}].reference_csv", k);
      found.error("E151", model.place_of(path), path, e.what(),
                  fmt::format("'{}' is compared with it, in {}", model.expect[k].probe,
                              column->unit.empty() || column->unit == "1" ? "plain numbers"
                                                                          : column->unit));
    }
  }
}

void check_frames(const Model& model, Diagnostics& found) {
  std::vector<std::string> names;
  for (const FieldSpec* f : fields::all) names.push_back(f->name);
  const auto& asked = model.output.frames.fields;
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (std::find(names.begin(), names.end(), asked[k]) != names.end()) continue;
    const std::string path = fmt::format("output.frames.fields[{}]", k);
    const std::string near = suggestion(asked[k], names);
    found.error("E152", model.place_of(path), path, fmt::format("there is no field '{}'", asked[k]),
                near.empty() ? "'sphgeo list' prints all fields" : near);
  }
}

}  // namespace

void check_outputs(const Model& model, Diagnostics& found) {
  check_claims(model, found);
  check_frames(model, found);
}

}  // namespace sphgeo
