#include "plan/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "plan/record_plan.h"
#include "sph/parameters.h"

namespace sphgeo {
namespace {

bool produces(Access a) { return a == Access::write; }
bool reads(Access a) { return a == Access::read || a == Access::update || a == Access::previous; }

bool same(const FieldUse& a, const FieldUse& b) { return a.set == b.set && a.field == b.field; }

// Order within a stage: who reads the previous value, then write, add, update, read.
int rank(Access a) {
  switch (a) {
    case Access::previous:
      return 0;
    case Access::write:
      return 1;
    case Access::add:
      return 2;
    case Access::update:
      return 3;
    default:
      return 4;
  }
}

bool must_precede(const Needs& first, const Needs& second) {
  for (const FieldUse& a : first.fields)
    for (const FieldUse& b : second.fields)
      if (same(a, b) && rank(a.access) < rank(b.access)) return true;
  return records_precede(first.records, second.records);
}

}  // namespace

template <int Dim>
Plan<Dim>::Plan(World<Dim>& world, const std::vector<Wish>& wishes) : world_(world) {
  bind(wishes);
  for (auto& e : effects_) {
    for (const FieldUse& use : e.needs.fields)
      if (!use.optional) world_.set(use.set).require(*use.field);
    for (const RecordUse& use : e.needs.records)
      world_.records().require(use.set, use.record->array);
    for (const ListUse& list : e.needs.lists) world_.require_list(list.target, list.source);
    for (const std::string& set : e.needs.reference_lists) world_.require_reference_list(set);
  }
  check_producers(wishes);
  order();
  check_records(records());
  for (auto& e : effects_) e.effect->prepare(world_);
  for (auto& e : effects_) {
    const auto& lists = e.needs.lists;
    const bool within = std::any_of(lists.begin(), lists.end(),
                                    [](const ListUse& l) { return l.target == l.source; });
    if (lists.empty() || within) continue;  // such effects walk everybody
    e.walked_set = lists.front().target;
    e.walked_list = &world_.list(lists.front().target, lists.front().source);
  }
}

template <int Dim>
void Plan<Dim>::bind(const std::vector<Wish>& wishes) {
  std::vector<PlannedEffect<Dim>> supporting;
  for (const auto& entry : EffectRegistry::all()) {
    const auto& off = world_.parameters().without;
    if (std::find(off.begin(), off.end(), entry.info.name) != off.end()) {
      unused_.push_back({entry.info.name, "switched off by the deck: " + entry.info.when_off});
      continue;
    }
    Binding<Dim> binding = entry.template bind<Dim>(world_);
    if (binding.effects.empty()) unused_.push_back({entry.info.name, binding.because});
    for (auto& effect : binding.effects) {
      PlannedEffect<Dim> planned{
          entry.info, std::move(effect), {}, binding.because, entry.info.name};
      if (binding.effects.size() > 1) planned.label += " (" + planned.effect->acts_on() + ")";
      planned.needs = planned.effect->needs();
      (entry.info.supporting ? supporting : effects_).push_back(std::move(planned));
    }
  }
  // Pull in supporting effects until nothing changes.
  const auto wanted_by = [&](const PlannedEffect<Dim>& candidate) -> std::string {
    for (const FieldUse& made : candidate.needs.fields) {
      if (!produces(made.access) && made.access != Access::add) continue;
      for (const auto& e : effects_) {
        // What is made for observers serves no one but observers.
        if (candidate.info.stage == Stage::observe && e.info.stage != Stage::observe) continue;
        for (const FieldUse& use : e.needs.fields)
          if (same(made, use) && reads(use.access) && !use.optional) return "effect " + e.info.name;
      }
      for (const Wish& w : wishes)
        if (w.set == made.set && w.field == made.field->name) return w.who;
    }
    for (const auto& e : effects_)
      if ((candidate.info.stage != Stage::observe || e.info.stage == Stage::observe) &&
          serves_records(candidate.needs.records, e.needs.records))
        return "effect " + e.info.name;
    return {};
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (auto it = supporting.begin(); it != supporting.end(); ++it) {
      const std::string who = wanted_by(*it);
      if (who.empty()) continue;
      it->because = "asked for by " + who;
      effects_.push_back(std::move(*it));
      supporting.erase(it);
      changed = true;
      break;
    }
  }
  for (const auto& e : supporting)
    unused_.push_back({e.info.name, "no effect, probe or frame reads what it computes"});
}

template <int Dim>
void Plan<Dim>::check_producers(const std::vector<Wish>& wishes) const {
  for (std::size_t k = 0; k < effects_.size(); ++k) {
    const auto& e = effects_[k];
    for (const FieldUse& use : e.needs.fields) {
      std::vector<std::string> writers, same_stage;
      for (const auto& other : effects_)
        for (const FieldUse& w : other.needs.fields)
          if (same(w, use) && produces(w.access)) {
            writers.push_back(other.info.name);
            if (other.info.stage == e.info.stage) same_stage.push_back(other.info.name);
          }
      const bool derived = use.field->lifetime == Lifetime::derived;
      if (use.optional && writers.empty()) continue;
      if (use.access == Access::previous && derived)
        throw std::logic_error(fmt::format(
            "plan: effect '{}' needs the previous value of field '{}' of set '{}', which is not "
            "saved",
            e.info.name, use.field->name, use.set));
      if (use.access == Access::scratch)
        throw std::logic_error(fmt::format(
            "plan: effect '{}' names field '{}' of set '{}' as scratch: only records are",
            e.info.name, use.field->name, use.set));
      if (derived && !produces(use.access) && writers.empty())
        throw std::logic_error(
            fmt::format("plan: effect '{}' needs field '{}' of set '{}', which no effect computes",
                        e.info.name, use.field->name, use.set));
      if (use.access == Access::add && same_stage.empty())
        throw std::logic_error(
            fmt::format("plan: effect '{}' adds to field '{}' of set '{}', which no effect of "
                        "stage '{}' sets first",
                        e.info.name, use.field->name, use.set, stage_name(e.info.stage)));
      if (produces(use.access) && same_stage.size() > 1)
        throw std::logic_error(fmt::format(
            "plan: effects '{}' and '{}' both set field '{}' of set '{}' in stage '{}'",
            same_stage[0], same_stage[1], use.field->name, use.set, stage_name(e.info.stage)));
    }
  }
  for (const Wish& w : wishes) {
    ParticleSet<Dim>& set = world_.set(w.set);
    const auto it = set.fields().find(w.field);
    if (it == set.fields().end() && !w.optional)
      throw std::logic_error(
          fmt::format("plan: {} asks for field '{}' of set '{}', which no effect computes", w.who,
                      w.field, w.set));
  }
}

template <int Dim>
void Plan<Dim>::order() {
  std::vector<PlannedEffect<Dim>> left = std::move(effects_), sorted;
  std::sort(left.begin(), left.end(), [](const auto& a, const auto& b) {
    if (a.info.stage != b.info.stage) return a.info.stage < b.info.stage;
    if (a.info.name != b.info.name) return a.info.name < b.info.name;
    return a.effect->acts_on() < b.effect->acts_on();
  });
  while (!left.empty()) {
    const Stage stage = left.front().info.stage;
    auto ready = left.end();
    for (auto it = left.begin(); it != left.end() && it->info.stage == stage; ++it) {
      bool free = true;
      for (auto other = left.begin(); other != left.end() && other->info.stage == stage; ++other)
        if (other != it && must_precede(other->needs, it->needs)) free = false;
      if (free) {
        ready = it;
        break;
      }
    }
    if (ready == left.end())
      throw std::logic_error(
          fmt::format("plan: the effects of stage '{}' wait for each other, beginning with '{}'",
                      stage_name(stage), left.front().info.name));
    sorted.push_back(std::move(*ready));
    left.erase(ready);
  }
  effects_ = std::move(sorted);
}

template <int Dim>
void Plan<Dim>::run(Stage stage) {
  for (auto& e : effects_) {
    if (e.info.stage != stage) continue;
    const typename RecordStore<Dim>::Running running(world_.records(), e.label, e.needs.records);
    {
      const Stopwatch watch(e.spent, e.calls);
      e.effect->apply(world_);
    }
    ++e.calls;
    if (e.walked_list == nullptr) continue;
    e.walked += static_cast<double>(e.walked_list->active());
    e.in_set += static_cast<double>(e.walked_list->target_count());
  }
}

template <int Dim>
StepLimits Plan<Dim>::limits() const {
  StepLimits limits;
  for (const auto& e : effects_) e.effect->limit(world_, limits);
  // Where solids are alone, the acoustic step is theirs.
  if (limits.acoustic == std::numeric_limits<double>::infinity())
    limits.lower_acoustic(limits.solid, "solids");
  const double factor = world_.parameters().numerics.time_step_factor;
  limits.advection *= factor;
  limits.acoustic *= factor;
  limits.solid *= factor;
  return limits;
}

template <int Dim>
std::vector<FieldBound> Plan<Dim>::bounds() const {
  std::vector<FieldBound> watched;
  for (const auto& e : effects_) e.effect->bounds(world_, watched);
  return watched;
}

template <int Dim>
void Plan<Dim>::save(StateSink& sink) const {
  for (const auto& e : effects_) {
    sink.put_count("effects/" + e.label + "/calls", e.calls);
    put_spent(sink, "effects/" + e.label + "/spent", e.spent);
    e.effect->save(sink, "effects/" + e.label + "/state/");
    if (e.walked_list == nullptr) continue;
    sink.put_number("effects/" + e.label + "/walked", e.walked);
    sink.put_number("effects/" + e.label + "/in_set", e.in_set);
  }
}

template <int Dim>
void Plan<Dim>::load(const StateSource& source) {
  for (auto& e : effects_) {
    e.effect->load(source, "effects/" + e.label + "/state/");
    // An observer may be new: what is asked of a run may change when it goes on.
    if (!source.has("effects/" + e.label + "/calls")) continue;
    e.calls = source.count("effects/" + e.label + "/calls");
    e.spent = spent_of(source, "effects/" + e.label + "/spent");
    if (!source.has("effects/" + e.label + "/walked")) continue;
    e.walked = source.number("effects/" + e.label + "/walked");
    e.in_set = source.number("effects/" + e.label + "/in_set");
  }
}

template <int Dim>
std::vector<std::pair<std::string, FieldBase*>> Plan<Dim>::ready_fields() const {
  std::map<std::string, FieldBase*> found;  // by the name in the file, each once
  for (const auto& maker : effects_)
    for (const FieldUse& made : maker.needs.fields)
      for (const auto& user : effects_)
        for (const FieldUse& use : user.needs.fields)
          if (maker.info.stage == Stage::reinitialize && user.info.stage != Stage::reinitialize &&
              user.info.stage != Stage::observe && made.access != Access::read &&
              made.field->lifetime == Lifetime::derived && same(made, use))
            found[made.set + "/" + made.field->name] = &world_.set(made.set).require(*made.field);
  return {found.begin(), found.end()};
}

template <int Dim>
void Plan<Dim>::save_within_step(StateSink& sink) const {
  for (const auto& [name, field] : ready_fields()) field->save(sink, "within_step/" + name);
}

template <int Dim>
void Plan<Dim>::load_within_step(const StateSource& source) {
  for (const auto& [name, field] : ready_fields()) field->load(source, "within_step/" + name);
  for (auto& e : effects_) {
    if (e.info.stage != Stage::reinitialize) continue;
    const typename RecordStore<Dim>::Running running(world_.records(), e.label, e.needs.records);
    e.effect->restore(world_);
  }
}

template <int Dim>
std::vector<EffectRecords> Plan<Dim>::records() const {
  std::vector<EffectRecords> all;
  for (const auto& e : effects_) all.push_back({e.label, e.info.stage, &e.needs.records});
  return all;
}

template <int Dim>
std::size_t Plan<Dim>::bytes() const {
  std::size_t sum = 0;
  for (const auto& e : effects_) sum += e.effect->bytes();
  return sum;
}

template class Plan<2>;
template class Plan<3>;

}  // namespace sphgeo
