#pragma once
// What an effect is: one sum of the paper (or a few that share one walk over the same pairs), the
// stage of Algorithm 2 it belongs to, and what it reads and writes.

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "particles/fields.h"
#include "sph/world.h"

namespace sphgeo {

/// The stages of Algorithm 2 at which effects run, in order.
enum class Stage {
  exchange,       ///< once per advection step, before particles are sorted: some enter, some leave
  reinitialize,   ///< once per advection step, after the neighbor lists are new (lines 11, 12)
  predict,        ///< to the middle of the acoustic step (Eq. 96)
  force,          ///< accelerations at the middle (Eqs. 59, 60)
  kick,           ///< velocity and position at the end (Eqs. 97, 98)
  solid_predict,  ///< kappa times per acoustic step: solids to the middle of their own step (Eq.
                  ///< 99)
  solid_force,    ///< their accelerations there (Eqs. 65, 79)
  solid_kick,     ///< their velocity and position at its end (Eqs. 100, 101)
  solid_finish,   ///< once per acoustic step: the surface of the solids as water and soil use it
  rate,           ///< rates of density with the new velocities, also of the solids (Eq. 58)
  correct,        ///< density at the end (Eq. 98)
  observe         ///< only when a probe or a frame is due
};
inline constexpr Stage all_stages[] = {
    Stage::exchange,     Stage::reinitialize,  Stage::predict,     Stage::force,
    Stage::kick,         Stage::solid_predict, Stage::solid_force, Stage::solid_kick,
    Stage::solid_finish, Stage::rate,          Stage::correct,     Stage::observe};
const char* stage_name(Stage stage);

struct FieldUse {
  std::string set;
  const FieldSpec* field;
  Access access;
  bool optional = false;  ///< the effect does without where no other effect computes it
};

struct ListUse {
  std::string target, source;
};

struct Needs {
  std::vector<FieldUse> fields;
  std::vector<ListUse> lists;
  std::vector<std::string> reference_lists = {};  ///< sets of solids whose pairs at rest are walked
  std::vector<RecordUse> records = {};

  /// Names fields of record R of a set; all of them where none is given.
  template <class R, class... F>
  Needs& record(const std::string& set, Access access, F...) {
    const unsigned slots = sizeof...(F) == 0 ? R::spec.slots() : (0U | ... | F::slots);
    records.push_back({set, &R::spec, access, slots});
    return *this;
  }
};

/// What `check --explain`, the time table and the reference page say of an effect.
struct EffectInfo {
  std::string name;
  Stage stage;
  std::string equations;
  std::string sentence;
  /// A supporting effect runs only when something active reads a field that it writes.
  bool supporting = false;
  /// What a scene is without it, as "soil does not feel ..."; empty for an effect that no deck can
  /// switch off.
  std::string when_off = {};
};

/// Upper bounds of the three clocks, s, and the fastest particle that they rest on.
struct StepLimits {
  double advection = std::numeric_limits<double>::infinity();
  double acoustic = std::numeric_limits<double>::infinity();
  double solid = std::numeric_limits<double>::infinity();
  const char* acoustic_by = "nothing";  ///< what bounds the acoustic step
  double mach = 0;      ///< largest |v| / c of any set; NaN when a velocity is no number
  std::string fastest;  ///< the set that holds it
  double water_mach = 0;

  /// `by` tells what asks for the bound.
  void lower_acoustic(double bound, const char* by) {
    if (!(bound < acoustic)) return;
    acoustic = bound;
    acoustic_by = by;
  }
  void note_speed(const std::string& set, double speed_over_sound) {
    if (mach != mach || speed_over_sound <= mach) return;
    mach = speed_over_sound;
    fastest = set;
  }
};

/// What a scalar field must stay within; the guard watches it.
struct FieldBound {
  std::string set;
  const FieldSpec* field;
  double low, high;                      ///< SI
  std::string cause_below, cause_above;  ///< what to look for when it is left
};

/// What an effect counts beside its fields, for the ledger.
struct Tally {
  std::string name;
  std::string unit;
  std::string sentence;
  double value = 0;
};

template <int Dim>
class Effect {
 public:
  virtual ~Effect() = default;
  virtual std::string acts_on() const = 0;
  virtual Needs needs() const = 0;
  /// Called once, after all fields and lists exist: take references here.
  virtual void prepare(World<Dim>&) {}
  virtual void apply(World<Dim>&) = 0;
  /// For a run that goes on in the middle of an advection step: brings back what apply() of the
  /// reinitialize stage left outside of the fields for the acoustic steps. The clock shows the
  /// start of the advection step.
  virtual void restore(World<Dim>&) {}
  /// Saves what apply() keeps from step to step outside of the fields, under names that begin with
  /// `at`; load() takes it back, after prepare(). Nothing else may be kept.
  virtual void save(StateSink&, const std::string& /*at*/) const {}
  virtual void load(const StateSource&, const std::string& /*at*/) {}
  /// Lowers the bounds to what this effect stays stable with.
  virtual void limit(const World<Dim>&, StepLimits&) const {}
  /// Adds what the guard is to watch.
  virtual void bounds(const World<Dim>&, std::vector<FieldBound>&) const {}
  /// Adds what the effect has counted.
  virtual void tally(std::vector<Tally>&) const {}
  /// Memory that the effect keeps beside fields and lists [bytes].
  virtual std::size_t bytes() const { return 0; }
};

/// An effect's answer to a scene: instances, or none; the sentence says why in both cases.
template <int Dim>
struct Binding {
  std::vector<std::unique_ptr<Effect<Dim>>> effects;
  std::string because;

  Binding(std::string why_not) : because(std::move(why_not)) {}
  Binding(const char* why_not) : because(why_not) {}
  template <class E>
  Binding(std::unique_ptr<E> effect, std::string why) : because(std::move(why)) {
    effects.push_back(std::move(effect));
  }
};

/// The registered effects, sorted by name.
class EffectRegistry {
 public:
  struct Entry {
    EffectInfo info;
    Binding<2> (*bind2)(const World<2>&);
    Binding<3> (*bind3)(const World<3>&);

    template <int Dim>
    Binding<Dim> bind(const World<Dim>& world) const {
      if constexpr (Dim == 2) return bind2(world);
      else return bind3(world);
    }
  };
  static const std::vector<Entry>& all();

 private:
  template <template <int> class>
  friend class RegisterEffect;
  static std::vector<Entry>& entries();
};

/// Self-registration: `const RegisterEffect<MyEffect> registered_my_effect;` at the end of the
/// effect's file. MyEffect needs `static EffectInfo info()` and `static Binding<Dim> bind(const
/// World<Dim>&)`.
template <template <int> class E>
class RegisterEffect {
 public:
  RegisterEffect() {
    EffectRegistry::entries().push_back({E<3>::info(), &E<2>::bind, &E<3>::bind});
  }
};

}  // namespace sphgeo
