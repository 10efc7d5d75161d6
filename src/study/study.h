#pragma once
// A study: runs of one deck with different settings, and the evaluation of their results.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "study/convergence.h"
#include "study/price.h"
#include "study/variation.h"

namespace sphgeo {

/// One `expect` of a run, as its summary.json has it.
struct RecordedResult {
  std::string name;
  std::optional<double> value, reference, error;
  double tolerance = 0;
  bool pass = false;
  std::string note;
};

/// Results of a run, from its summary.json.
struct RunOutcome {
  std::string status;   ///< done, unstable, stopped, failed; "missing" without a summary
  std::string message;  ///< why it did not end as planned
  double wall_s = 0;
  long particles = 0;  ///< of all sets
  long acoustic_steps = 0;
  double memory_bytes = 0;
  int threads = 1;
  std::optional<double> forecast_wall_s, forecast_memory_bytes;
  std::vector<RecordedResult> results;

  const RecordedResult* result(const std::string& name) const;
};

/// Reads summary.json of a run folder; status "missing" when there is none or it cannot be read.
RunOutcome read_outcome(const std::string& folder);

/// A run of the study.
struct StudyRun {
  std::vector<Setting> settings;
  double spacing = 0;  ///< particle spacing that the settings lead to, m
  std::string folder;  ///< below the study's
  RunOutcome record;
};

/// A result that a deck claims, and the kind of its errors.
struct StudyClaim {
  std::string name;
  bool relative = true;  ///< errors are shares (of the reference or of a curve's range)
  double tolerance = 0;
  bool norm =
      false;  ///< the value is an error itself (a curve's norm, or a value with an upper bound)
};

/// One result along one curve.
struct StudyResult {
  std::string name;
  const StudyCurve* curve = nullptr;
  std::vector<const StudyRun*>
      runs;  ///< done and with a value; coarsest first where spacings differ
  std::vector<RecordedResult> values;  ///< of these runs
  std::vector<std::string> left_out;   ///< settings and why: a run that failed or has no such value
  std::vector<std::optional<double>> errors;
  std::string error_against;  ///< "the reference", "the finest run", or empty
  bool by_spacing = false;    ///< whether all spacings differ, so that there is an order
  Convergence convergence;    ///< by_spacing only
  std::vector<bool> worth;    ///< on the Pareto front of all curves of this result
  std::string price;          ///< the sentence

  std::optional<double> reference() const {
    return values.empty() ? std::nullopt : values.front().reference;
  }
};

struct Study {
  std::string deck, title, date, machine, version;
  std::vector<Variation> varied;
  StudyDesign design;
  std::vector<StudyRun> runs;
  std::vector<StudyClaim> claims;
};

/// The results of the runs so far, claim by claim, curve by curve.
std::vector<StudyResult> study_results(const Study& study);

/// The value of a run's setting, as written; "" when it has no such setting.
std::string setting_of(const StudyRun& run, const std::string& key);
/// The claim of that name, which must exist.
const StudyClaim& claim_of(const Study& study, const std::string& name);
/// "1.5 %" or "0.015"; "-" for none.
std::string error_cell(const std::optional<double>& error, bool relative);
/// "monotone; order 1.02 (from the values); Richardson 0.51; GCI 1.2 %".
std::string convergence_text(const Convergence& convergence);

/// study.json.
nlohmann::ordered_json to_json(const Study& study, const std::vector<StudyResult>& results);

/// A page that needs no other file: for each result its errors against the time they took, with the
/// Pareto front, and its table; then the runs.
std::string study_page(const Study& study, const std::vector<StudyResult>& results);

/// Tables and sentences for the terminal.
std::string render_study(const Study& study, const std::vector<StudyResult>& results);

}  // namespace sphgeo
