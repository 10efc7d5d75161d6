#pragma once
// Self-registration: one file per shape, material, boundary or probe, without changes elsewhere.
//
//   struct Box final : Shape { Vec3 min, max; static Schema<Box> schema(); ... };
//   static const Register<Shape, Box> registered_box{"box"};           // in box.cpp
//
// The `type:` key of a mapping in the deck selects the class. The interface I has a public
// `std::string type` that the reader sets to that name, and may declare keys that all its types
// share by `static Schema<I> common();`.

#include <concepts>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "deck/key.h"

namespace sphgeo {

template <class P>
class Schema;
template <class P>
const SchemaCore& schema_of();

/// One registered type.
struct RegistryEntry {
  std::string name;
  const SchemaCore& (*schema)();      ///< its own keys
  std::shared_ptr<void> (*create)();  ///< a new object, as its interface
  void* (*object)(void* interface);   ///< interface -> the type's own address
};

/// All registered types of one interface, without its C++ type.
class RegistryCore {
 public:
  RegistryCore(std::string kind_name, const SchemaCore* (*common_keys)())
      : interface_name_(std::move(kind_name)), common_(common_keys) {}

  /// "shape", "material": what an error calls it.
  const std::string& interface_name() const { return interface_name_; }
  /// Keys that every type has; nullptr when there are none.
  const SchemaCore* common() const { return common_(); }
  const std::vector<RegistryEntry>& entries() const { return entries_; }  ///< sorted by name
  const RegistryEntry* find(const std::string& name) const;
  std::vector<std::string> names() const;
  /// Throws std::logic_error when the name is taken.
  void add(RegistryEntry entry);

 private:
  std::string interface_name_;
  const SchemaCore* (*common_)();
  std::vector<RegistryEntry> entries_;
};

template <class I>
concept HasCommonKeys = requires {
  I::common();
};

/// The registry of an interface I, which names itself by `static constexpr const char* kind`.
template <class I>
class Registry {
 public:
  static const RegistryCore& get() { return core(); }

 private:
  template <class, class>
  friend class Register;

  static const SchemaCore* common() {
    if constexpr (HasCommonKeys<I>) {
      static const Schema<I> keys = I::common();
      return &keys;
    } else {
      return nullptr;
    }
  }
  static RegistryCore& core() {
    static RegistryCore types{I::kind, &Registry::common};
    return types;
  }
};

/// Registers P as a type of the interface I; a static object in the type's own file.
template <class I, class P>
class Register {
 public:
  explicit Register(std::string name) {
    static_assert(std::derived_from<P, I> && std::default_initializable<P>);
    Registry<I>::core().add(
        {std::move(name), &schema_of<P>,
         []() -> std::shared_ptr<void> {
           return std::static_pointer_cast<I>(std::make_shared<P>());
         },
         [](void* face) -> void* { return static_cast<P*>(static_cast<I*>(face)); }});
  }
};

}  // namespace sphgeo
