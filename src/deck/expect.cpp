// The section `expect`: what a deck claims of its results.

#include "core/error.h"
#include "deck/model.h"
#include "deck/reference_curve.h"

namespace sphgeo {
namespace {

/// An unusable table is reported before the run, not after it.
void check_reference(const Expect& e, CheckContext& c) {
  try {
    read_reference(e, std::nullopt);
  } catch (const Error& error) {
    c.error("reference_csv", error.what());
  }
}

}  // namespace

Schema<Expect> Expect::schema() {
  Schema<Expect> s("expect",
                   "A result the deck claims, from a probe, with reference and tolerance.");
  s.required("name", &Expect::name, unit::none, "the name of the result");
  s.required("probe", &Expect::probe, unit::none, "a probe, or one of its columns as probe.column");
  s.optional(
       "reduce", &Expect::reduce, unit::none,
       "how the column becomes one number; growth: its largest rise above any earlier value; "
       "curve: compared with reference_csv as a whole; profile: all heights of a probe at one "
       "time, compared with reference_csv over the distance along its line")
      .choices({"last", "first", "min", "max", "max_abs", "mean", "rms", "range", "growth",
                "time_of_min", "time_of_max", "period", "frequency", "slope", "at", "curve",
                "profile"});
  s.optional(
       "at", &Expect::at, unit::time,
       "the time of the value, for reduce: at; of the profile, for reduce: profile (auto: the last "
       "sample)")
      .at_least(0);
  s.optional("from", &Expect::from, unit::time, "start of the time window; auto: the first sample");
  s.optional("to", &Expect::to, unit::time, "end of the time window; auto: the last sample");
  s.optional("shift", &Expect::shift, unit::none,
             "added to the measured numbers, before the scale");
  s.optional("scale", &Expect::scale, unit::none, "the measured numbers are divided by it");
  s.optional("reference", &Expect::reference, unit::none, "the expected number");
  s.optional("reference_csv", &Expect::reference_csv, unit::none,
             "table of the reference, for reduce: curve (over time) and profile (over distance)");
  s.optional("x", &Expect::x, unit::none, "abscissa column of the table; auto: the first");
  s.optional("y", &Expect::y, unit::none, "ordinate column of the table; auto: the second");
  s.optional("x_scale", &Expect::x_scale, unit::none, "the table's abscissae are multiplied by it");
  s.optional("x_shift", &Expect::x_shift, unit::none,
             "added to the scaled abscissae, for a table with another origin of time");
  s.optional("y_scale", &Expect::y_scale, unit::none, "the table's ordinates are multiplied by it");
  s.optional("norm", &Expect::norm, unit::none,
             "of the difference of two curves: l2 and max by the range of the reference, "
             "relative_l2 by its root mean square")
      .choices({"l2", "max", "relative_l2"});
  s.required("tolerance", &Expect::tolerance, unit::none,
             "largest error; for measure below or above: the bound itself");
  s.optional("tolerance_kind", &Expect::tolerance_kind, unit::none,
             "relative: a fraction of the reference")
      .choices({"relative", "absolute"});
  s.optional("measure", &Expect::measure, unit::none,
             "within: near the reference; below, above: the value against the tolerance")
      .choices({"within", "below", "above"});
  s.optional("source", &Expect::source, unit::none, "where the reference comes from");
  s.check([](Expect& e, CheckContext& c) {
    const bool profile = e.reduce == "profile", curve = profile || e.reduce == "curve";
    if (curve != e.reference_csv.has_value()) {
      c.error(curve ? "reduce" : "reference_csv",
              curve ? "reduce: " + e.reduce + " needs a 'reference_csv'"
                    : "'reference_csv' is used only with reduce: curve or profile");
      return;
    }
    if (profile && (e.from || e.to))
      c.error(e.from ? "from" : "to", "a profile is that of one time",
              "give 'at', the time, instead of 'from' and 'to'");
    if (curve) check_reference(e, c);
    if (e.reduce == "at" && !e.at) c.error("reduce", "reduce: at needs the time 'at'");
    if (e.reduce != "at" && !profile && e.at)
      c.error("at", "'at' has no meaning unless reduce is at or profile");
    if (!curve && e.measure == "within" && !e.reference) {
      c.error("", "the result has no reference", "give 'reference', or measure: below or above");
    }
    if (e.reference && (curve || e.measure != "within")) {
      c.error("reference", "'reference' has no meaning here",
              "it belongs to one number with measure: within");
    }
    if (e.scale == 0.0) c.error("scale", "'scale' must not be 0");
    if (e.measure == "within" && e.tolerance < 0.0)
      c.error("tolerance", "'tolerance' must not be negative");
    if (e.measure == "within" && !curve && e.tolerance_kind == "relative" && e.reference == 0.0) {
      c.error("reference", "a relative tolerance needs a reference other than 0",
              "set tolerance_kind: absolute");
    }
    if (e.from && e.to && *e.from >= *e.to) c.error("to", "'to' must be later than 'from'");
  });
  return s;
}

}  // namespace sphgeo
