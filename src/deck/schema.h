#pragma once
// Binds each key of a deck section to a member of a struct, once. Reading, range and unit check,
// defaults, resolved.yaml, JSON Schema and reference all follow from that one declaration.
//
//   Schema<Tank> Tank::schema() {
//     Schema<Tank> s("tank", "An open box of walls.");
//     s.required("size", &Tank::size, unit::length, "Inner edge lengths.").above(0);
//     s.optional("slip", &Tank::slip, unit::none, "Wall friction.").choices({"no_slip",
//     "free_slip"}); s.check([](Tank& t, CheckContext& c) { if (...) c.error("size", "..."); });
//     return s;
//   }

#include <array>
#include <concepts>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/types.h"
#include "deck/key.h"
#include "deck/registry.h"

namespace sphgeo {

/// A file named in the deck; `path` is absolute, found relative to the deck file that names it.
struct FilePath {
  std::string path;
};

/// One of the key's choices, or a formula: `pressure: hydrostatic`, `pressure: 100*z`.
struct WordOrExpression {
  std::string word;  ///< empty when a formula is given
  Expression formula;
};

/// How T is read and written; defined for the types listed in this header, and for structs that
/// have `static Schema<T> schema()`.
template <class T>
const ValueType& value_type();

template <>
const ValueType& value_type<double>();
template <>
const ValueType& value_type<int>();
template <>
const ValueType& value_type<Index>();
template <>
const ValueType& value_type<bool>();
template <>
const ValueType& value_type<std::string>();
template <>
const ValueType& value_type<Vec3>();
template <>
const ValueType& value_type<Expression>();
template <>
const ValueType& value_type<std::array<Expression, 3>>();
template <>
const ValueType& value_type<FilePath>();
template <>
const ValueType& value_type<WordOrExpression>();
template <>
const ValueType& value_type<Variables>();

/// The declaration of a section that fills a P. Keys without a value in the deck keep that of P{}.
template <class P>
class Schema : public SchemaCore {
 public:
  using SchemaCore::taken_before;
  Schema(std::string type_name, std::string sentence)
      : SchemaCore(std::move(type_name), std::move(sentence)) {}

  template <class T, class B>
  Key& required(std::string name, T B::*member, Unit unit, std::string sentence) {
    return add(std::move(name), member, unit, true, std::move(sentence));
  }
  template <class T, class B>
  Key& optional(std::string name, T B::*member, Unit unit, std::string sentence) {
    return add(std::move(name), member, unit, false, std::move(sentence));
  }
  /// A rule across keys, run once the whole deck is sound in structure; parts before wholes.
  Schema& check(std::function<void(P&, CheckContext&)> rule) {
    rules_.push_back([rule = std::move(rule)](void* object, CheckContext& context) {
      rule(*static_cast<P*>(object), context);
    });
    return *this;
  }

  /// Names a key that is taken out of the mapping before this section is read.
  void taken_before(std::string name) { taken_before_.push_back(std::move(name)); }

 private:
  template <class T, class B>
  Key& add(std::string name, T B::*member, Unit unit, bool required, std::string sentence) {
    static_assert(std::derived_from<P, B> || std::same_as<P, B>);
    return keys_.emplace_back(
        std::move(name), value_type<T>(), unit, required, std::move(sentence),
        [member](void* p) -> void* { return &(static_cast<P*>(p)->*member); });
  }
};

/// The schema of a struct P, declared by `P::schema()`, made at first use.
template <class P>
const SchemaCore& schema_of() {
  static const Schema<P> schema = P::schema();
  return schema;
}

// Composite types: the work is done in composite_types.cpp through these few hooks.

/// std::vector<T>.
struct ListHooks {
  const ValueType& (*element)();
  std::size_t (*size)(const void*);
  void (*resize)(void*, std::size_t);
  void* (*at)(void*, std::size_t);
};
/// std::optional<T>; `auto` in the deck stands for the empty one.
struct OptionalHooks {
  const ValueType& (*element)();
  bool (*has_value)(const void*);
  void (*reset)(void*);
  void* (*emplace)(void*);  ///< makes a value and returns its address
  const void* (*get)(const void*);
};
/// A nested struct.
struct StructHooks {
  const SchemaCore& (*schema)();
  std::shared_ptr<void> (*create)();
};
/// std::shared_ptr<const I>.
struct PolymorphicHooks {
  const RegistryCore& (*registry)();
  void (*assign)(void*, std::shared_ptr<void>);
  const void* (*get)(const void*);
  std::string& (*type_name)(void* interface);
};

std::unique_ptr<const ValueType> make_list_type(ListHooks hooks);
std::unique_ptr<const ValueType> make_optional_type(OptionalHooks hooks);
std::unique_ptr<const ValueType> make_struct_type(StructHooks hooks);
std::unique_ptr<const ValueType> make_polymorphic_type(PolymorphicHooks hooks);

/// Builds the ValueType of a composite; the primary template is a nested struct.
template <class T>
struct Composite {
  static std::unique_ptr<const ValueType> make() {
    return make_struct_type(
        {&schema_of<T>, []() -> std::shared_ptr<void> { return std::make_shared<T>(); }});
  }
};

template <class T>
struct Composite<std::vector<T>> {
  using V = std::vector<T>;
  static std::unique_ptr<const ValueType> make() {
    return make_list_type(
        {&value_type<T>, [](const void* v) { return static_cast<const V*>(v)->size(); },
         [](void* v, std::size_t n) { *static_cast<V*>(v) = V(n); },
         [](void* v, std::size_t i) -> void* { return &(*static_cast<V*>(v))[i]; }});
  }
};

template <class T>
struct Composite<std::optional<T>> {
  using O = std::optional<T>;
  static std::unique_ptr<const ValueType> make() {
    return make_optional_type(
        {&value_type<T>, [](const void* o) { return static_cast<const O*>(o)->has_value(); },
         [](void* o) { static_cast<O*>(o)->reset(); },
         [](void* o) -> void* { return &static_cast<O*>(o)->emplace(); },
         [](const void* o) -> const void* { return &**static_cast<const O*>(o); }});
  }
};

template <class I>
struct Composite<std::shared_ptr<const I>> {
  using S = std::shared_ptr<const I>;
  static std::unique_ptr<const ValueType> make() {
    return make_polymorphic_type(
        {&Registry<I>::get,
         [](void* s, std::shared_ptr<void> object) {
           *static_cast<S*>(s) = std::static_pointer_cast<const I>(std::move(object));
         },
         [](const void* s) -> const void* { return static_cast<const S*>(s)->get(); },
         [](void* face) -> std::string& { return static_cast<I*>(face)->type; }});
  }
};

template <class T>
const ValueType& value_type() {
  static const std::unique_ptr<const ValueType> type = Composite<T>::make();
  return *type;
}

}  // namespace sphgeo
