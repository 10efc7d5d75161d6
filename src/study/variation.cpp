#include "study/variation.h"

#include <algorithm>

#include "core/error.h"
#include "core/text.h"

namespace sphgeo {

namespace {

/// Adds the run unless it is there already; its index.
std::size_t add_run(StudyDesign& design, std::vector<Setting> settings) {
  const auto at = std::find(design.runs.begin(), design.runs.end(), settings);
  if (at != design.runs.end()) return static_cast<std::size_t>(at - design.runs.begin());
  design.runs.push_back(std::move(settings));
  return design.runs.size() - 1;
}

/// Adds a curve along `along` for every combination of the variations from `next` on.
void combine(StudyDesign& design, const Variation& along, const std::vector<Variation>& all,
             std::size_t next, std::vector<Setting> others) {
  if (next < all.size()) {
    for (const std::string& value : all[next].values) {
      std::vector<Setting> more = others;
      more.emplace_back(all[next].key, value);
      combine(design, along, all, next + 1, std::move(more));
    }
    return;
  }
  StudyCurve curve{along.key, others, {}};
  for (const std::string& value : along.values) {
    std::vector<Setting> settings = {{along.key, value}};
    settings.insert(settings.end(), others.begin(), others.end());
    curve.runs.push_back(add_run(design, std::move(settings)));
  }
  design.curves.push_back(std::move(curve));
}

}  // namespace

Variation parse_variation(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    return Error(ExitCode::usage,
                 "--vary '" + printable(text) + "': " + why + "; expected KEY=VALUE,VALUE...");
  };
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw refuse("there is no key with values");
  Variation v{std::string(trimmed(text.substr(0, equals))), {}};
  std::string value;
  int depth = 0;
  char quote = 0;
  const auto take = [&] {
    const std::string whole(trimmed(value));
    if (whole.empty()) throw refuse("a value is missing");
    if (std::find(v.values.begin(), v.values.end(), whole) != v.values.end())
      throw refuse("'" + whole + "' is given twice");
    v.values.push_back(whole);
    value.clear();
  };
  for (const char c : text.substr(equals + 1)) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '[' || c == '{' || c == '(') {
      ++depth;
    } else if (c == ']' || c == '}' || c == ')') {
      --depth;
    } else if (c == ',' && depth == 0) {
      take();
      continue;
    }
    value += c;
  }
  if (quote != 0 || depth != 0) throw refuse("a bracket or quote is not closed");
  take();
  return v;
}

std::string settings_text(const std::vector<Setting>& settings) {
  std::string text;
  for (const auto& [key, value] : settings) text += (text.empty() ? "" : " ") + key + "=" + value;
  return text;
}

StudyDesign one_at_a_time(const std::vector<Variation>& variations) {
  StudyDesign design;
  for (const Variation& v : variations) combine(design, v, {}, 0, {});
  return design;
}

StudyDesign all_combinations(const std::vector<Variation>& variations) {
  StudyDesign design;
  if (!variations.empty()) combine(design, variations.front(), variations, 1, {});
  return design;
}

}  // namespace sphgeo
