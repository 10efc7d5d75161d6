#include "compare/tolerances.h"

#include <fnmatch.h>

#include "core/error.h"
#include "deck/yaml_reader.h"

namespace sphgeo {

Schema<ToleranceRule> ToleranceRule::schema() {
  Schema<ToleranceRule> s("tolerance", "A tolerance for single findings.");
  s.required("name", &ToleranceRule::name, unit::none,
             "name of the findings as they are printed; * stands for any part");
  s.required("tolerance", &ToleranceRule::tolerance, unit::none, "largest difference").at_least(0);
  return s;
}

Schema<Tolerances> Tolerances::schema() {
  Schema<Tolerances> s("tolerances", "Allowed differences of a run from its baseline.");
  s.optional("probes", &Tolerances::probes, unit::none,
             "root mean square of a curve's difference, by its range")
      .at_least(0);
  s.optional("fields", &Tolerances::fields, unit::none,
             "root mean square of a field's difference at nearest particles, by its range")
      .at_least(0);
  s.optional("positions", &Tolerances::positions, unit::none,
             "mean distance to the nearest particle, in spacings")
      .at_least(0);
  s.optional("ledger", &Tolerances::ledger, unit::none,
             "difference of a conserved quantity at the end, by its size")
      .at_least(0);
  s.optional("results", &Tolerances::results, unit::none,
             "difference of a result under 'expect', by its size")
      .at_least(0);
  s.optional("steps", &Tolerances::steps, unit::none, "difference in the number of steps")
      .at_least(0);
  s.optional("particles", &Tolerances::particles, unit::none,
             "difference in the number of particles")
      .at_least(0);
  s.optional("rules", &Tolerances::rules, unit::none,
             "tolerances for single findings; the last that matches applies");
  return s;
}

double Tolerances::of(const std::string& kind, const std::string& name) const {
  double tolerance = kind == "probe"       ? probes
                     : kind == "field"     ? fields
                     : kind == "positions" ? positions
                     : kind == "ledger"    ? ledger
                     : kind == "result"    ? results
                     : kind == "steps"     ? steps
                     : kind == "particles" ? particles
                                           : 0;
  const std::string whole = kind + " " + name;
  for (const ToleranceRule& rule : rules)
    if (::fnmatch(rule.name.c_str(), whole.c_str(), 0) == 0) tolerance = rule.tolerance;
  return tolerance;
}

Tolerances read_tolerances(const std::string& path) {
  Diagnostics found;
  Places places;
  DeckReading reading(found, places);
  reading.main_file = path;
  Tolerances tolerances;
  if (const auto text = read_text_file(path, {path, 0, 0}, found))
    if (const auto root = read_yaml(*text, path, found))
      read_mapping(*root, {{&schema_of<Tolerances>(), &tolerances}}, {}, reading);
  if (found.has_errors()) throw DeckError(found);
  return tolerances;
}

}  // namespace sphgeo
