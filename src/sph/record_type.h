#pragma once
// Packed records by name. A record type says what the 8 numbers of a record mean and in which array
// of its set they lie. Types of the same array share its storage: writing one voids the others as
// far as their numbers overlap, which the planner knows.
//
//   template <int Dim>
//   struct Water : RecordType<Dim, Position<Dim>> {        // the position lies before it
//     static constexpr RecordField<Water, 3> volume{};
//     static constexpr RecordField<Water, 4, Dim> velocity{};
//     static constexpr RecordSpec spec{"water", 0, "...", {{"volume", volume}, ...}};
//   };

#include <array>
#include <string>
#include <type_traits>

namespace sphgeo {

/// What an effect does with a field or a record.
enum class Access {
  read,      ///< the value of this stage is needed, or what an earlier one left
  write,     ///< set from scratch
  add,       ///< summed onto a value that another effect wrote in the same stage; fields only
  update,    ///< changed in place
  previous,  ///< the value from before this stage is needed: of the last step, where it is written
             ///< once in a step
  scratch    ///< written and used up by the effect itself, void before and after; records only
};
/// Its name in messages.
const char* access_name(Access access);

/// Numbers At ... At + Count - 1 of a record of type R: a scalar, or the components of a vector or
/// tensor.
template <class R, int At, int Count = 1>
struct RecordField {
  static_assert(At >= 0 && Count > 0 && At + Count <= 8, "a record has 8 numbers");
  static constexpr int at = At, count = Count;
  static constexpr unsigned slots = ((1U << Count) - 1U) << At;
};

/// A field of a record at run time.
struct RecordFieldSpec {
  const char* name = nullptr;
  unsigned slots = 0;  ///< bit k: number k of the record

  constexpr RecordFieldSpec() = default;
  template <class R, int At, int Count>
  constexpr RecordFieldSpec(const char* field, RecordField<R, At, Count>)
      : name(field), slots(RecordField<R, At, Count>::slots) {}
};

/// A record type at run time, one object for each: compared by address.
struct RecordSpec {
  const char* name;
  int array;  ///< number of the array, among those of its set
  const char* sentence;
  std::array<RecordFieldSpec, 6> fields;  ///< the unused ones have no name
  bool arranged = false;  ///< written by the world at every rearrangement, not by an effect

  /// All its numbers, bit by bit.
  constexpr unsigned slots() const {
    unsigned all = 0;
    for (const RecordFieldSpec& f : fields) all |= f.slots;
    return all;
  }
};

/// Base of record types. `Below` is a record type of the same array that stays valid beside this
/// one, so that pairs find the fields of both in one record.
template <int Dim, class Below = void>
struct RecordType {
  static constexpr int dim = Dim;
  using Under = Below;
};

/// Whether the fields of Q are found in a record of type R: it is the same, or lies under it.
template <class R, class Q>
constexpr bool holds_record() {
  if constexpr (std::is_void_v<R>) return false;
  else if constexpr (std::is_same_v<R, Q>) return true;
  else return holds_record<typename R::Under, Q>();
}

/// The numbers that R and what lies between it and Q take from Q.
template <class R, class Q>
constexpr unsigned covered_slots() {
  if constexpr (std::is_same_v<R, Q>) return 0;
  else return R::spec.slots() | covered_slots<typename R::Under, Q>();
}

/// What an effect does with some fields of a record of a set.
struct RecordUse {
  std::string set;
  const RecordSpec* record;
  Access access;
  unsigned slots;  ///< which numbers of the record
};

/// Where a particle is for its pairs: in the first record of every set but solids. The world writes
/// it at every rearrangement; effects that move particles within the step, or shift them after it,
/// update it.
template <int Dim>
struct Position : RecordType<Dim> {
  static constexpr RecordField<Position, 0, Dim> position{};
  static constexpr RecordSpec spec{
      "position", 0, "where pairs find a particle", {{{"position", position}}}, true};
};

}  // namespace sphgeo
