#pragma once
// Bodies that leave the place of other bodies free.

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// What the key `around` of a body does, for the reference.
inline constexpr const char* around_sentence =
    "other bodies whose place it leaves free; the name of a body with `copies` means all of them";

/// Takes the key `around` out of every body: its shape becomes the difference of what it was and
/// the shapes of the bodies that are named, where NAME also means all copies NAME_1, NAME_2 ...
/// Copies must have been expanded.
void expand_around(Node& root, DeckReading& reading);

}  // namespace sphgeo
