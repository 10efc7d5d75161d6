// Baselines: results that later runs are compared with, small enough to be stored with the decks.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "compare/run_data.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* baseline_kind = "sphgeo baseline 1";

/// Seven digits: the tolerances of fields are far larger.
Json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.7g}", value).c_str(), nullptr);
}

Json list(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(number(v));
  return out;
}

std::vector<double> numbers_or_nan(const Json& j) {
  std::vector<double> out;
  for (const Json& x : j) out.push_back(x.is_null() ? std::nan("") : x.get<double>());
  return out;
}

/// Which of n rows are kept: evenly, first and last among them.
std::vector<std::size_t> even_choice(std::size_t n, std::size_t most) {
  std::vector<std::size_t> out;
  if (n <= most || most < 2) {
    for (std::size_t k = 0; k < n; ++k) out.push_back(k);
    return out;
  }
  for (std::size_t k = 0; k < most; ++k) out.push_back(k * (n - 1) / (most - 1));
  return out;
}

/// Which of n particles are kept: those with the least hashes, in their own order.
std::vector<std::size_t> random_choice(std::size_t n, std::size_t most) {
  std::vector<std::size_t> out(n);
  for (std::size_t k = 0; k < n; ++k) out[k] = k;
  if (n <= most) return out;
  std::nth_element(
      out.begin(), out.begin() + static_cast<std::ptrdiff_t>(most), out.end(),
      [](std::size_t a, std::size_t b) { return random_bits(1, a) < random_bits(1, b); });
  out.resize(most);
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<double> chosen(const std::vector<double>& values,
                           const std::vector<std::size_t>& which) {
  std::vector<double> out;
  for (const std::size_t k : which) out.push_back(values[k]);
  return out;
}

Json probes_json(const RunData& run, std::size_t rows) {
  Json out = Json::array();
  for (std::size_t first = 0; first < run.probes.size();) {
    const ProbeCurve& curve = run.probes[first];
    const auto which = even_choice(curve.t.size(), rows);
    Json probe = {
        {"name", curve.probe}, {"t", list(chosen(curve.t, which))}, {"columns", Json::object()}};
    for (; first < run.probes.size() && run.probes[first].probe == probe["name"]; ++first)
      probe["columns"][run.probes[first].column] = {
          {"unit", run.probes[first].unit}, {"values", list(chosen(run.probes[first].y, which))}};
    out.push_back(std::move(probe));
  }
  return out;
}

Json sets_json(const RunData& run, std::size_t particles) {
  Json out = Json::array();
  for (const SetState& set : run.sets) {
    const auto which = random_choice(set.positions.size(), particles);
    Json row = {{"name", set.set}, {"particles", set.particles}};
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> x;
      for (const std::size_t k : which) x.push_back(set.positions[k][axis]);
      row[std::string(1, "xyz"[axis])] = list(x);
    }
    row["fields"] = Json::object();
    for (const FieldState& field : set.fields)
      row["fields"][field.name] = list(chosen(field.values, which));
    out.push_back(std::move(row));
  }
  return out;
}

RunData from_json(const Json& j) {
  RunData run;
  run.title = j.at("title");
  run.status = j.at("status");
  run.version = j.at("version");
  run.date = j.at("date");
  run.resolution = j.at("resolution");
  run.time = j.at("time_s");
  for (const auto& [name, count] : j.at("steps").items())
    run.steps.emplace_back(name, count.get<double>());
  for (const auto& [name, row] : j.at("ledger").items())
    run.ledger.emplace_back(
        name, LedgerState{numbers_or_nan(row.at("initial")), numbers_or_nan(row.at("final"))});
  for (const auto& [name, row] : j.at("expect").items()) {
    ResultState result;
    if (row.at("value").is_number()) result.value = row.at("value").get<double>();
    result.tolerance = row.at("tolerance");
    result.pass = row.at("pass");
    run.results.emplace_back(name, result);
  }
  for (const Json& probe : j.at("probes")) {
    const std::vector<double> t = numbers_or_nan(probe.at("t"));
    if (!std::all_of(t.begin(), t.end(), [](double x) { return std::isfinite(x); }) ||
        !std::is_sorted(t.begin(), t.end()))
      throw std::runtime_error("the times of a probe do not rise");
    for (const auto& [column, row] : probe.at("columns").items()) {
      run.probes.push_back(
          {probe.at("name"), column, row.at("unit"), t, numbers_or_nan(row.at("values"))});
      if (run.probes.back().y.size() != t.size())
        throw std::runtime_error("a probe's column has another length than its times");
    }
  }
  for (const Json& row : j.at("sets")) {
    SetState set;
    set.set = row.at("name");
    if (!row.at("particles").is_number_unsigned())
      throw std::runtime_error("the number of particles is not a whole number");
    set.particles = row.at("particles").get<Index>();
    if (set.particles < 0 || set.particles > (Index{1} << 50))
      throw std::runtime_error("the number of particles is out of range");
    const std::vector<double> x = numbers_or_nan(row.at("x")), y = numbers_or_nan(row.at("y")),
                              z = numbers_or_nan(row.at("z"));
    if (x.size() != y.size() || x.size() != z.size())
      throw std::runtime_error("the positions of a set differ in length");
    for (std::size_t k = 0; k < x.size(); ++k) {
      set.positions.emplace_back(x[k], y[k], z[k]);
      if (!set.positions.back().allFinite())
        throw std::runtime_error("the position of a particle is not a number");
    }
    for (const auto& [name, values] : row.at("fields").items()) {
      set.fields.push_back({name, numbers_or_nan(values)});
      if (set.fields.back().values.size() != x.size())
        throw std::runtime_error("a field has another length than its set");
    }
    run.sets.push_back(std::move(set));
  }
  return run;
}

}  // namespace

void write_baseline(const std::string& path, const RunData& run, const BaselineSize& size) {
  Json j;
  j["kind"] = baseline_kind;
  j["title"] = run.title;
  j["version"] = run.version;
  const std::time_t now = std::time(nullptr);
  char date[16];
  std::strftime(date, sizeof date, "%Y-%m-%d", std::localtime(&now));
  j["date"] = date;
  j["status"] = run.status;
  j["resolution"] = run.resolution;
  j["time_s"] = number(run.time);
  j["steps"] = Json::object();
  for (const auto& [name, count] : run.steps) j["steps"][name] = count;
  j["ledger"] = Json::object();
  for (const auto& [name, row] : run.ledger)
    j["ledger"][name] = {{"initial", list(row.initial)}, {"final", list(row.final)}};
  j["expect"] = Json::object();
  for (const auto& [name, r] : run.results)
    j["expect"][name] = {{"value", r.value ? number(*r.value) : Json(nullptr)},
                         {"tolerance", r.tolerance},
                         {"pass", r.pass}};
  j["probes"] = probes_json(run, size.rows);
  j["sets"] = sets_json(run, size.particles);
  // One line a top-level entry: a change of one of them shows as such.
  std::string text = "{\n";
  std::size_t left = j.size();
  for (const auto& [key, value] : j.items())
    text += Json(key).dump() + ": " + value.dump(-1, ' ', false, Json::error_handler_t::replace) +
            (--left > 0 ? ",\n" : "\n");
  write_file_atomically(path, text + "}\n");
}

RunData read_baseline(const std::string& path) {
  const Json j = Json::parse(read_file(path), nullptr, false);
  const auto at = j.is_object() ? j.find("kind") : j.end();
  if (!j.is_object() || at == j.end() || *at != baseline_kind)
    throw Error(ExitCode::usage,
                path +
                    ": this is not a baseline; expected a run folder, or a file that "
                    "'sphgeo compare RUN FILE --update' has written");
  try {
    RunData run = from_json(j);
    run.path = path;
    return run;
  } catch (const std::exception& e) {
    throw Error(ExitCode::usage, path + ": this baseline is damaged: " + e.what());
  }
}

}  // namespace sphgeo
