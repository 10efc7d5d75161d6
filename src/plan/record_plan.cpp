#include "plan/record_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <tuple>

namespace sphgeo {
namespace {

bool same_place(const RecordUse& a, const RecordUse& b) {
  return a.set == b.set && a.record->array == b.record->array && (a.slots & b.slots) != 0;
}
bool needs_value(Access a) {
  return a == Access::read || a == Access::previous || a == Access::update;
}
bool replaces(Access a) { return a == Access::write || a == Access::scratch; }

// Order of uses of one record within a stage.
int record_rank(Access a) {
  switch (a) {
    case Access::previous:
      return 0;
    case Access::write:
      return 1;
    case Access::update:
      return 2;
    default:
      return 3;
  }
}

std::string field_names(const RecordUse& use) {
  std::string names;
  for (const RecordFieldSpec& f : use.record->fields)
    if ((f.slots & use.slots) != 0) names += fmt::format("{}{}", names.empty() ? "" : ", ", f.name);
  return names;
}

// Whose numbers the arrays hold, while the effects run one after the other.
class Holdings {
 public:
  explicit Holdings(const std::vector<EffectRecords>& in_order) : in_order_(in_order) {
    for (const EffectRecords& e : in_order)
      for (const RecordUse& use : *e.uses)
        if (use.record->arranged)
          arranged_.push_back({use.set, use.record, Access::write, use.record->slots()});
  }

  // At a rearrangement particles change their places in the arrays.
  void rearrange() {
    held_.clear();
    for (const RecordUse& use : arranged_) put(use, "the rearrangement");
  }

  void run(Stage stage) {
    for (const EffectRecords& e : in_order_) {
      if (e.stage != stage) continue;
      for (const RecordUse& use : *e.uses)
        if (needs_value(use.access)) find(use, e.effect);
      for (const RecordUse& use : *e.uses)
        if (replaces(use.access)) put(use, e.effect);
    }
  }

 private:
  struct Held {
    const RecordSpec* record = nullptr;  // null: void
    std::string by;                      // who has written or voided it
  };

  std::array<Held, 8>& at(const RecordUse& use) { return held_[{use.set, use.record->array}]; }

  void put(const RecordUse& use, const std::string& by) {
    for (unsigned k = 0; k < 8; ++k)
      if ((use.slots >> k & 1U) != 0)
        at(use)[k] = {use.access == Access::scratch ? nullptr : use.record, by};
  }

  void find(const RecordUse& use, const std::string& effect) {
    for (unsigned k = 0; k < 8; ++k) {
      if ((use.slots >> k & 1U) == 0) continue;
      const Held& held = at(use)[k];
      if (held.record == use.record) continue;
      const std::string what = fmt::format("plan: effect '{}' reads record '{}' ({}) of set '{}'",
                                           effect, use.record->name, field_names(use), use.set);
      if (held.by.empty()) throw std::logic_error(what + ", which no effect writes before it");
      throw std::logic_error(held.record
                                 ? fmt::format("{}, where '{}' has packed record '{}'", what,
                                               held.by, held.record->name)
                                 : fmt::format("{}, which '{}' has used up", what, held.by));
    }
  }

  const std::vector<EffectRecords>& in_order_;
  std::vector<RecordUse> arranged_;
  std::map<std::pair<std::string, int>, std::array<Held, 8>> held_;
};

void check_writers(const std::vector<EffectRecords>& effects) {
  for (std::size_t k = 0; k < effects.size(); ++k)
    for (std::size_t l = 0; l < k; ++l)
      for (const RecordUse& a : *effects[k].uses)
        for (const RecordUse& b : *effects[l].uses)
          if (effects[k].stage == effects[l].stage && same_place(a, b) &&
              a.access == Access::write && b.access == Access::write)
            throw std::logic_error(fmt::format(
                "plan: effects '{}' and '{}' both write record '{}'{} of set '{}' in stage '{}'",
                effects[l].effect, effects[k].effect, b.record->name,
                a.record == b.record ? "" : fmt::format(" and '{}' over it", a.record->name), a.set,
                stage_name(effects[k].stage)));
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

}  // namespace

bool records_precede(const std::vector<RecordUse>& first, const std::vector<RecordUse>& second) {
  for (const RecordUse& a : first)
    for (const RecordUse& b : second) {
      if (!same_place(a, b)) continue;
      const bool one_record =
          a.record == b.record && a.access != Access::scratch && b.access != Access::scratch;
      if (one_record ? record_rank(a.access) < record_rank(b.access)
                     : needs_value(a.access) && replaces(b.access))
        return true;
    }
  return false;
}

bool serves_records(const std::vector<RecordUse>& maker, const std::vector<RecordUse>& user) {
  for (const RecordUse& made : maker)
    for (const RecordUse& use : user)
      if (made.access == Access::write && needs_value(use.access) && made.record == use.record &&
          same_place(made, use))
        return true;
  return false;
}

void check_records(const std::vector<EffectRecords>& in_order) {
  for (const EffectRecords& e : in_order)
    for (const RecordUse& use : *e.uses)
      if (use.access == Access::add)
        throw std::logic_error(
            fmt::format("plan: effect '{}' adds to record '{}': records are "
                        "written or updated",
                        e.effect, use.record->name));
  check_writers(in_order);
  Holdings held(in_order);
  using enum Stage;
  held.run(exchange);
  held.rearrange();
  held.run(reinitialize);
  held.run(observe);
  for (int acoustic_step = 0; acoustic_step < 2; ++acoustic_step) {
    for (const Stage stage : {predict, force, kick}) held.run(stage);
    for (int solid_step = 0; solid_step < 2; ++solid_step)
      for (const Stage stage : {solid_predict, solid_force, solid_kick}) held.run(stage);
    for (const Stage stage : {solid_finish, rate, correct}) held.run(stage);
  }
  held.run(observe);
}

std::vector<RecordRow> record_rows(const std::vector<EffectRecords>& in_order) {
  std::map<std::tuple<std::string, int, std::string>, RecordRow> rows;
  for (const EffectRecords& e : in_order)
    for (const RecordUse& use : *e.uses) {
      RecordRow& row = rows[{use.set, use.record->array, use.record->name}];
      row.set = use.set;
      row.record = use.record;
      if (use.access == Access::scratch) add_once(row.used_up_by, e.effect);
      else if (use.access == Access::write || use.access == Access::update)
        add_once(row.written_by, e.effect);
      else add_once(row.read_by, e.effect);
    }
  std::vector<RecordRow> all;
  for (auto& [key, row] : rows) {
    if (row.record->arranged) row.written_by.insert(row.written_by.begin(), "rearrangement");
    for (const auto& [other_key, other] : rows)
      if (other.set == row.set && other.record != row.record &&
          other.record->array == row.record->array &&
          (other.record->slots() & row.record->slots()) != 0)
        row.shares_with.push_back(other.record->name);
    all.push_back(row);
  }
  return all;
}

}  // namespace sphgeo
