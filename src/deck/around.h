#pragma once
// Bodies from which the shapes of other bodies are cut out.

#include "deck/interfaces.h"
#include "deck/schema.h"

namespace sphgeo {

/// Description of the key `around`, for the reference.
inline constexpr const char* around_sentence =
    "other bodies whose shapes are cut out of it; the name of a body with `copies` means all of "
    "them";

/// Takes the key `around` out of every body: its shape becomes the difference of its own and the
/// shapes of the named bodies, where NAME also means all copies NAME_1, NAME_2 ... Copies must have
/// been expanded.
void expand_around(Node& root, DeckReading& reading);

}  // namespace sphgeo
