#include "study/study.h"

#include <algorithm>
#include <cmath>

#include "core/atomic_file.h"
#include "core/error.h"
#include "report/run_record.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;

RecordedResult recorded(const Json& row) {
  const Json& pass = value_at(row, "/pass");
  return {text_at(row, "/name"),
          number_at(row, "/value"),
          number_at(row, "/reference"),
          number_at(row, "/error"),
          number_at(row, "/tolerance").value_or(0),
          pass.is_boolean() && pass.get<bool>(),
          text_at(row, "/note")};
}

/// Why a run has no value of a claim.
std::string why_not(const RunOutcome& record, const RecordedResult* r) {
  if (record.status == "missing") return "it has no summary";
  if (record.status != "done")
    return record.status + (record.message.empty() ? "" : ", " + record.message);
  if (r == nullptr) return "its deck does not claim this";
  return r->note.empty() ? "it could not be measured" : r->note;
}

/// The runs of a curve that have the claim; coarsest first where spacings differ.
StudyResult gather(const Study& study, const StudyCurve& curve, const StudyClaim& claim) {
  StudyResult result;
  result.name = claim.name;
  result.curve = &curve;
  for (const std::size_t k : curve.runs) {
    const StudyRun& run = study.runs[k];
    const RecordedResult* r = run.record.result(claim.name);
    if (run.record.status == "done" && r != nullptr && r->value) result.runs.push_back(&run);
    else result.left_out.push_back(setting_of(run, curve.key) + ": " + why_not(run.record, r));
  }
  std::vector<const StudyRun*> sorted = result.runs;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const StudyRun* a, const StudyRun* b) { return a->spacing > b->spacing; });
  const auto equal = [](const StudyRun* a, const StudyRun* b) { return a->spacing == b->spacing; };
  result.by_spacing =
      sorted.size() > 1 && std::adjacent_find(sorted.begin(), sorted.end(), equal) == sorted.end();
  if (result.by_spacing) result.runs = sorted;
  for (const StudyRun* run : result.runs) result.values.push_back(*run->record.result(claim.name));
  return result;
}

void judge(StudyResult& result, const StudyClaim& claim) {
  const auto& values = result.values;
  const bool known = std::any_of(values.begin(), values.end(),
                                 [](const RecordedResult& r) { return r.error.has_value(); });
  if (known) {
    for (const RecordedResult& r : values) result.errors.push_back(r.error);
    result.error_against = "the reference";
  } else if (result.by_spacing) {
    // The finest run has no error against itself.
    const double finest = *values.back().value;
    const double unit = claim.relative && finest != 0 ? std::abs(finest) : 1;
    for (const RecordedResult& r : values)
      result.errors.emplace_back(std::abs(*r.value - finest) / unit);
    result.errors.back().reset();
    result.error_against = "the finest run";
  } else {
    result.errors.resize(values.size());
  }
  if (!result.by_spacing) return;
  std::vector<Level> levels;
  for (std::size_t k = 0; k < values.size(); ++k)
    levels.push_back(
        {result.runs[k]->spacing, *values[k].value, known ? result.errors[k] : std::nullopt});
  result.convergence = convergence(levels);
  if (claim.norm || values.back().reference == 0.0)
    result.convergence.gci.reset();  // a fraction of an error that tends to zero has no meaning
}

Offer offer(const StudyResult& result, std::size_t k) {
  const StudyRun& run = *result.runs[k];
  return {setting_of(run, result.curve->key), run.spacing, run.record.wall_s, result.errors[k]};
}

void price(StudyResult& result, const StudyClaim& claim) {
  std::vector<Offer> offers;
  for (std::size_t k = 0; k < result.runs.size(); ++k) offers.push_back(offer(result, k));
  const ErrorScale scale{claim.relative,
                         result.error_against == "the reference" ? claim.tolerance : 0,
                         result.error_against};
  result.price =
      result.by_spacing ? price_of_spacing(offers, scale) : price_of_settings(offers, scale);
}

/// Marks the Pareto front of all curves of one claim.
void mark_front(std::span<StudyResult> curves) {
  std::vector<Offer> offers;
  for (const StudyResult& r : curves)
    for (std::size_t k = 0; k < r.runs.size(); ++k) offers.push_back(offer(r, k));
  const std::vector<bool> worth = worth_their_time(offers);
  std::size_t next = 0;
  for (StudyResult& r : curves)
    for (std::size_t k = 0; k < r.runs.size(); ++k) r.worth.push_back(worth[next++]);
}

}  // namespace

const RecordedResult* RunOutcome::result(const std::string& name) const {
  for (const RecordedResult& r : results)
    if (r.name == name) return &r;
  return nullptr;
}

RunOutcome read_outcome(const std::string& folder) {
  RunOutcome run;
  run.status = "missing";
  Json summary;
  try {
    summary = Json::parse(read_file(folder + "/summary.json"), nullptr, false);
  } catch (const IoError&) {
    return run;
  }
  if (text_at(summary, "/status").empty()) return run;
  run.status = text_at(summary, "/status");
  run.message = text_at(summary, "/message");
  run.wall_s = number_at(summary, "/wall_s").value_or(0);
  run.memory_bytes = number_at(summary, "/memory_peak_bytes").value_or(0);
  run.threads = static_cast<int>(number_at(summary, "/threads").value_or(1));
  run.acoustic_steps = static_cast<long>(number_at(summary, "/steps/acoustic").value_or(0));
  for (const Json& count : value_at(summary, "/particles"))
    if (count.is_number()) run.particles += count.get<long>();
  run.forecast_wall_s = number_at(summary, "/forecast/wall_s");
  run.forecast_memory_bytes = number_at(summary, "/forecast/memory_bytes");
  for (const Json& row : value_at(summary, "/expect"))
    if (row.is_object()) run.results.push_back(recorded(row));
  return run;
}

std::string setting_of(const StudyRun& run, const std::string& key) {
  for (const auto& [name, value] : run.settings)
    if (name == key) return value;
  return "";
}

std::vector<StudyResult> study_results(const Study& study) {
  std::vector<StudyResult> results;
  for (const StudyClaim& claim : study.claims) {
    const std::size_t first = results.size();
    for (const StudyCurve& curve : study.design.curves) {
      StudyResult result = gather(study, curve, claim);
      if (result.runs.empty()) {
        result.price = "no run has a value of it";
      } else {
        judge(result, claim);
        price(result, claim);
      }
      results.push_back(std::move(result));
    }
    // Errors against different runs cannot be compared.
    const std::span<StudyResult> curves = std::span(results).subspan(first);
    const bool common = std::all_of(curves.begin(), curves.end(), [](const StudyResult& r) {
      return r.error_against == "the reference";
    });
    for (std::size_t k = 0; k < curves.size(); k += common ? curves.size() : 1)
      mark_front(curves.subspan(k, common ? curves.size() : 1));
  }
  return results;
}

}  // namespace sphgeo
