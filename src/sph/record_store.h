#pragma once
// All packed records of a scene, and the check that an effect uses those only that it has named.

#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "sph/record_type.h"
#include "sph/records.h"

namespace sphgeo {

/// The record arrays of all sets, in the precision of the pair sums.
template <int Dim>
class RecordStore {
 public:
  /// Makes an array of records of a set; it has room after resize().
  void require(const std::string& set, int array) { arrays_[{set, array}]; }
  bool holds(const std::string& set, int array) const { return arrays_.contains({set, array}); }
  /// Makes room in all arrays of a set; what they held is void.
  void resize(const std::string& set, Index n, const FixedPoint<Dim>& frame, bool single);
  /// Memory of one array of a set, and of all [bytes].
  std::size_t bytes(const std::string& set, int array) const;
  std::size_t bytes() const;

  /// The numbers of one array. Throws std::logic_error when there is none.
  template <class T>
  Records<Dim, T>& array(const std::string& set, int number) {
    const auto found = arrays_.find({set, number});
    if (found == arrays_.end()) refuse_missing(set, number);
    return found->second.template get<T>();
  }
  template <class T>
  const Records<Dim, T>& array(const std::string& set, int number) const {
    const auto found = arrays_.find({set, number});
    if (found == arrays_.end()) refuse_missing(set, number);
    return found->second.template get<T>();
  }

  /// Records of type R of a set, to read or to pack. Throws std::logic_error when the running
  /// effect has not named them among its needs and uses are checked.
  template <class R, class T>
  RecordSource<R, T> read(const std::string& set) {
    if (running_) check_read<R>(set);
    return RecordSource<R, T>(array<T>(set, R::spec.array));
  }
  template <class R, class T>
  RecordPacking<R, T> write(const std::string& set) {
    check_write(set, R::spec);
    return RecordPacking<R, T>(array<T>(set, R::spec.array));
  }
  /// The check of write() alone.
  void check_write(const std::string& set, const RecordSpec& record) const {
    if (running_) check(set, record, true);
  }

  /// Whether uses are checked: by default in builds with assertions only.
  void check_uses(bool on) { checks_ = on; }
  bool checks_uses() const { return checks_; }

  /// While it lives, only the records of these uses may be asked for, when uses are checked.
  class Running {
   public:
    Running(RecordStore& store, const std::string& effect, std::span<const RecordUse> uses)
        : store_(store) {
      if (!store.checks_) return;
      store.running_ = true;
      store.effect_ = effect;
      store.uses_ = uses;
    }
    ~Running() { store_.running_ = false; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

   private:
    RecordStore& store_;
  };

 private:
  struct Arrays {
    Records<Dim, float> single;
    Records<Dim, double> full;  // one of both stays empty
    std::size_t bytes() const { return single.bytes() + full.bytes(); }
    template <class T>
    Records<Dim, T>& get() {
      if constexpr (std::is_same_v<T, float>) return single;
      else return full;
    }
    template <class T>
    const Records<Dim, T>& get() const {
      if constexpr (std::is_same_v<T, float>) return single;
      else return full;
    }
  };

  // A record brings with it those that lie under it.
  template <class R>
  void check_read(const std::string& set) const {
    check(set, R::spec, false);
    if constexpr (!std::is_void_v<typename R::Under>) check_read<typename R::Under>(set);
  }
  void check(const std::string& set, const RecordSpec& record, bool writes) const;
  [[noreturn]] static void refuse_missing(const std::string& set, int array);

  std::map<std::pair<std::string, int>, Arrays> arrays_;
#ifdef NDEBUG
  bool checks_ = false;
#else
  bool checks_ = true;
#endif
  bool running_ = false;
  std::string effect_;
  std::span<const RecordUse> uses_;
};

extern template class RecordStore<2>;
extern template class RecordStore<3>;

}  // namespace sphgeo
