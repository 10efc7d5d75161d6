#pragma once
// The loop over pairs: for each particle i, sums over its neighbors j. It owns loading, padding,
// summing and threads; an effect brings a pair function and says what to do with the sums.
//
//   struct Pressure {                                 // plain arithmetic on a number type T
//     Kernel<Dim> kernel;
//     template <class T> struct Sums { LaneVec<Dim, T> force{}; };
//     template <class T>
//     void operator()(Sums<T>& sum, const Record<T, Water>& i, const Record<T, Water>& j,
//                     const LaneVec<Dim, T>& r, const T& r2) const {
//       sum.force -= (i[Water::p] + j[Water::p]) * j[Water::V] * kernel.dw_over_r(r2) * r;
//     }
//   };
//   gather<Pressure::Sums>(list, records, records, Pressure{kernel},
//                          [&](Index i, const Pressure::Sums<double>& sum) { ... });
//
// i and j are the records, r = r_i - r_j [m] (so r / |r| is e_ij and r W'(r)/r the gradient of W at
// i), r2 = r . r. Only i is written, so results do not depend on the number of threads.

#include <array>
#include <bit>
#include <type_traits>

#include "core/error.h"
#include "core/parallel.h"
#include "sph/neighbor_list.h"
#include "sph/records.h"

namespace sphgeo {

namespace detail {

// r_i - r_j of two records, in metres.
template <int Dim, class T, class F>
LaneVec<Dim, T> separation(const T* i, const T* j, F quantum) {
  LaneVec<Dim, T> r;
  for (int d = 0; d < Dim; ++d) {
    if constexpr (std::is_same_v<typename ScalarOf<T>::type, float>) {
      using Ints = typename T::Mask;
      const Ints difference = std::bit_cast<Ints>(i[d].raw) - std::bit_cast<Ints>(j[d].raw);
      r[d] = T(__builtin_convertvector(difference, typename T::Raw)) * quantum;
    } else {
      r[d] = i[d] - j[d];
    }
  }
  return r;
}

// One particle in all lanes.
template <class L, class T, class... R>
Record<L, R...> spread(const RecordView<T, R...>& records, Index i) {
  Record<L, R...> record;
  for (int n = 0; n < records.parts; ++n)
    for (int k = 0; k < record_size; ++k)
      record.slot[n * record_size + k] = L((*records.part[n])[i][k]);
  return record;
}

// The sums as an array of numbers: a struct of sums holds numbers of its type and nothing else.
template <template <class> class Sums, class T>
using SumArray = std::array<T, sizeof(Sums<T>) / sizeof(T)>;

template <template <class> class Sums, class L>
Sums<double> reduce(const Sums<L>& lanes) {
  static_assert(std::is_trivially_copyable_v<Sums<L>> && sizeof(Sums<L>) % sizeof(L) == 0 &&
                    sizeof(Sums<L>) / sizeof(L) == sizeof(Sums<double>) / sizeof(double),
                "a struct of sums holds numbers and vectors of its type T only");
  const auto from = std::bit_cast<SumArray<Sums, L>>(lanes);
  SumArray<Sums, double> to{};
  for (std::size_t k = 0; k < from.size(); ++k) to[k] = static_cast<double>(sum(from[k]));
  return std::bit_cast<Sums<double>>(to);
}

// Throws Error (internal) if records are not those of the list's sets: the null record of the list
// must be that of the sources.
template <class T, class... R, class... Q>
void check_records(const NeighborList& list, const RecordView<T, R...>& targets,
                   const RecordView<T, Q...>& sources) {
  if (targets.size() != list.target_count() || sources.size() != list.source_count() ||
      !(targets.frame() == sources.frame()))
    throw Error(ExitCode::internal, "a pass over pairs met records of another set");
}

// gather for one block of a list, in the calling thread.
template <template <class> class Sums, class T, class... R, class... Q, class Pair, class Finish>
void walk_block(const NeighborList::Block& block, const RecordView<T, R...>& targets,
                const RecordView<T, Q...>& sources, const Pair& pair_function,
                const Finish& finish) {
  using L = Lanes<T>;
  constexpr int Dim = RecordView<T, R...>::dim, M = sizeof...(Q);
  // Copies: the compiler keeps them in registers, as nothing in the loop can write them.
  const Pair pair = pair_function;
  const T quantum = static_cast<T>(sources.frame().quantum);
  std::array<const T*, M> base;
  for (int m = 0; m < M; ++m) base[static_cast<std::size_t>(m)] = sources.part[m]->data();

  for (std::size_t k = 0; k < block.size(); ++k) {
    const auto i = static_cast<Index>(block.targets[k]);
    const Record<L, R...> record_i = detail::spread<L>(targets, i);
    Sums<L> sums{};
    // The last lanes may meet the null record; the list is long enough for any width.
    const std::uint32_t* e = block.entries.data() + block.begin[k];
    const std::uint32_t* end = e + block.count[k];
    for (; e < end; e += L::width) {
      // The list is a stream of its own beside the records.
      __builtin_prefetch(e + 1024);
      Record<L, Q...> record_j;
      for (int m = 0; m < M; ++m)
        load_records(base[static_cast<std::size_t>(m)], e, record_j.slot + m * record_size);
      const LaneVec<Dim, L> r = detail::separation<Dim>(record_i.slot, record_j.slot, quantum);
      pair(sums, record_i, record_j, r, dot(r, r));
    }
    finish(i, detail::reduce<Sums>(sums));
  }
}

}  // namespace detail

/// Calls finish(i, sums) for every walked target i of the list, with sums (in double) of
/// pair(sums, i, j, r, r2) over its neighbors. `targets` and `sources` are RecordSources, or
/// several of one set joined by with(); both sides have the frame of the list's grid. Sums are
/// taken in the precision of the records. finish runs in parallel and may write what belongs to i
/// only. Throws Error (internal) if the records are not those of the list's sets.
template <template <class> class Sums, class Targets, class Sources, class Pair, class Finish>
void gather(const NeighborList& list, const Targets& target_records, const Sources& source_records,
            const Pair& pair_function, const Finish& finish) {
  const auto targets = view(target_records);
  const auto sources = view(source_records);
  detail::check_records(list, targets, sources);
  const auto blocks = list.blocks();
  parallel_blocks(static_cast<Index>(blocks.size()), 1, [&](Index b, Index, Index) {
    detail::walk_block<Sums>(blocks[static_cast<std::size_t>(b)], targets, sources, pair_function,
                             finish);
  });
}

/// gather for targets [256 b, 256 b + 256) of the list only, in the calling thread: for passes that
/// walk several lists of the same targets.
template <template <class> class Sums, class Targets, class Sources, class Pair, class Finish>
void gather_block(const NeighborList& list, Index b, const Targets& target_records,
                  const Sources& source_records, const Pair& pair_function, const Finish& finish) {
  const auto targets = view(target_records);
  const auto sources = view(source_records);
  detail::check_records(list, targets, sources);
  detail::walk_block<Sums>(list.blocks()[static_cast<std::size_t>(b)], targets, sources,
                           pair_function, finish);
}

/// What gather does, over all pairs nearer than `radius` [m], in plain double and one thread: the
/// reference of tests. Every target is finished.
template <template <class> class Sums, class Targets, class Sources, class Pair, class Finish>
void brute_force(const Targets& target_records, const Sources& source_records, double radius,
                 Pairing pairing, const Pair& pair, const Finish& finish) {
  const auto targets = view(target_records);
  const auto sources = view(source_records);
  for (Index i = 0; i < targets.size(); ++i) {
    const auto record_i = detail::spread<double>(targets, i);
    Sums<double> sums{};
    for (Index j = 0; j < sources.size(); ++j) {
      if (pairing == Pairing::within && i == j) continue;
      const auto record_j = detail::spread<double>(sources, j);
      const auto r = detail::separation<targets.dim>(record_i.slot, record_j.slot, 1.0);
      const double r2 = dot(r, r);
      if (r2 < radius * radius) pair(sums, record_i, record_j, r, r2);
    }
    finish(i, sums);
  }
}

}  // namespace sphgeo
