#include "output/summary.h"

#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "core/atomic_file.h"

namespace sphgeo {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

/// A scalar as a number, a vector as a list.
Json numbers(const std::vector<double>& values) {
  if (values.size() == 1) return number(values.front());
  Json list = Json::array();
  for (const double v : values) list.push_back(number(v));
  return list;
}

Json guard_json(const GuardReport& guard) {
  Json out = {{"tripped", guard.tripped}};
  if (guard.tripped) {
    out["reason"] = guard.reason;
    out["cause"] = guard.cause;
    out["effect"] = guard.effect;
    out["set"] = guard.set;
    out["particle"] = guard.particle ? Json(*guard.particle) : Json(nullptr);
    if (guard.place)
      out["position"] = numbers({guard.place->x(), guard.place->y(), guard.place->z()});
    else out["position"] = nullptr;
    out["time_s"] = number(guard.time);
  }
  for (const auto& [name, value] : guard.extremes) out[name] = number(value);
  return out;
}

}  // namespace

Json to_json(const Summary& s) {
  Json out;
  out["status"] = s.status;
  out["exit_code"] = s.exit_code;
  if (!s.message.empty()) out["message"] = s.message;
  out["version"] = s.version;
  out["title"] = s.title;
  out["deck"] = s.deck;
  out["deck_hash"] = s.deck_hash;
  out["dimension"] = s.dimension;
  out["threads"] = s.threads;
  out["particles"] = Json::object();
  for (const auto& [set, count] : s.particles) out["particles"][set] = count;
  out["steps"] = {
      {"advection", s.advection_steps}, {"acoustic", s.acoustic_steps}, {"solid", s.solid_steps}};
  out["time_s"] = number(s.time_s);
  out["wall_s"] = number(s.wall_s);
  out["busy"] = number(s.busy);
  out["particle_updates_per_s_per_core"] = number(s.particle_updates_per_s_per_core);
  out["memory_peak_bytes"] = s.memory_peak_bytes;
  out["effects"] = Json::array();
  for (const TimeRow& r : s.effects) {
    out["effects"].push_back({{"name", r.name},
                              {"calls", r.calls},
                              {"seconds", number(r.spent.seconds)},
                              {"share", number(r.share)},
                              {"busy", number(r.busy)}});
    if (!r.walked_set.empty())
      out["effects"].back()["walks"] = {{"set", r.walked_set}, {"share", number(r.walked_share)}};
  }
  out["plan"] = Json::array();
  for (const PlanRow& r : s.plan)
    out["plan"].push_back({{"stage", r.stage},
                           {"name", r.name},
                           {"equations", r.equations},
                           {"acts_on", r.acts_on},
                           {"because", r.because}});
  out["expect"] = Json::array();
  for (const ExpectResult& e : s.expect) {
    Json row = {{"name", e.name},
                {"value", number(e.value)},
                {"reference", number(e.reference)},
                {"error", number(e.error)},
                {"tolerance", number(e.tolerance)},
                {"pass", e.pass}};
    if (!e.note.empty()) row["note"] = e.note;
    out["expect"].push_back(std::move(row));
  }
  out["ledger"] = Json::object();
  for (const LedgerRow& r : s.ledger) {
    Json row = {{"unit", r.unit}, {"initial", numbers(r.initial)}, {"final", numbers(r.final)}};
    if (!r.exchanged.empty()) row["exchanged"] = numbers(r.exchanged);
    row["relative_error"] = number(r.relative_error);
    out["ledger"][r.name] = std::move(row);
  }
  if (s.forecast) {
    out["forecast"] = to_json(*s.forecast);
    out["forecast"]["actual"] =
        to_json(RunFigures{s.particles, s.memory_peak_bytes, s.disk_bytes, s.advection_steps,
                           s.acoustic_steps, s.wall_s, 0});
  }
  out["guard"] = guard_json(s.guard);
  out["checkpoints"] = {{"count", s.checkpoint.count},
                        {"seconds", number(s.checkpoint.seconds)},
                        {"bytes", s.checkpoint.bytes}};
  return out;
}

void write_summary(const std::string& path, const Summary& summary) {
  // Names come from the deck, which may hold bytes that are no UTF-8: replace them rather than
  // fail.
  write_file_atomically(
      path, to_json(summary).dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

std::uint64_t peak_memory_bytes() {
  // Not ru_maxrss alone: that begins with what the process was before it became this program.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
  struct rusage usage {};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace sphgeo
