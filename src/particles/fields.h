#pragma once
// The fields that effects, probes and frames name. Each stands here once.

#include "particles/field.h"

namespace sphgeo::fields {

using enum FieldType;
using enum Lifetime;

inline constexpr FieldSpec id{"id", FieldType::identity, state, unit::none,
                              "number of the particle, kept for life"};
inline constexpr FieldSpec part{"part", tag, state, unit::none,
                                "index of the body or boundary of the deck"};
inline constexpr FieldSpec position{"position", vector, state, unit::length,
                                    "position of the particle"};
inline constexpr FieldSpec velocity{"velocity", vector, state, unit::speed, "velocity"};
inline constexpr FieldSpec acceleration{"acceleration", vector, state, unit::acceleration,
                                        "acceleration of the last acoustic step"};
inline constexpr FieldSpec acceleration_sum{
    "acceleration_sum", vector, derived, unit::acceleration,
    "sum of all forces by mass, of the running acoustic step"};
inline constexpr FieldSpec mass{"mass", scalar, reference, unit::mass,
                                "mass; kg per metre of depth in 2D"};
inline constexpr FieldSpec density{"density", scalar, state, unit::density,
                                   "intrinsic density of the water"};
inline constexpr FieldSpec density_rate{"density_rate", scalar, state, unit::none,
                                        "rate of change of the density, Eq. 58"};
inline constexpr FieldSpec pressure{"pressure", scalar, derived, unit::pressure,
                                    "pressure, Eq. 26"};
inline constexpr FieldSpec mean_pressure{"mean_pressure", scalar, state, unit::pressure,
                                         "pressure, mean over the advection step"};
inline constexpr FieldSpec volume{"volume", scalar, derived, unit::volume,
                                  "volume; an area in 2D, Eq. 27"};
inline constexpr FieldSpec surface{
    "surface", tag, state, unit::none,
    "1 on the free surface, 2 in spray: less than half the neighborhood is filled"};
inline constexpr FieldSpec normal{"normal", vector, state, unit::none, "outward normal of a wall"};
inline constexpr FieldSpec reference_position{"reference_position", vector, reference, unit::length,
                                              "position at t = 0"};
inline constexpr FieldSpec displacement{"displacement", vector, derived, unit::length,
                                        "displacement since t = 0"};
inline constexpr FieldSpec reference_normal{"reference_normal", vector, reference, unit::none,
                                            "normal at t = 0"};
inline constexpr FieldSpec no_slip{"no_slip", scalar, reference, unit::none,
                                   "1 where water sticks to the wall, 0 where it slides"};
inline constexpr FieldSpec corner{"corner", scalar, reference, unit::none,
                                  "1 behind two walls at once, in the concave corner between them"};

// Soil.
inline constexpr FieldSpec volume_fraction{"volume_fraction", scalar, state, unit::none,
                                           "share of the grains in the volume, n^s"};
inline constexpr FieldSpec volume_fraction_rate{"volume_fraction_rate", scalar, state, unit::rate,
                                                "rate of change of the volume fraction, Eq. 48"};
inline constexpr FieldSpec initial_volume_fraction{"initial_volume_fraction", scalar, reference,
                                                   unit::none, "volume fraction at t = 0"};
inline constexpr FieldSpec stress{"stress", tensor, state, unit::pressure,
                                  "effective stress, tension positive: xx, yy, zz, xy, yz, xz"};
inline constexpr FieldSpec number_density_ratio{
    "number_density_ratio", scalar, derived, unit::none,
    "sum over neighbors at their volume at rest, over that of a lattice"};
inline constexpr FieldSpec gradient_correction{
    "gradient_correction", tensor, state, unit::none,
    "inverse moment of the kernel gradient: xx, yy, zz, xy, yz, xz"};
inline constexpr FieldSpec plastic_strain{"plastic_strain", scalar, state, unit::none,
                                          "accumulated equivalent plastic strain"};
inline constexpr FieldSpec plastic_work{
    "plastic_work", scalar, state, unit::energy,
    "energy dissipated by plastic flow; J per metre of depth in 2D"};
inline constexpr FieldSpec water_acceleration{
    "water_acceleration", vector, state, unit::acceleration,
    "acceleration of soil by pore pressure and drag in the last acoustic step"};
inline constexpr FieldSpec pore_pressure{"pore_pressure", scalar, derived, unit::pressure,
                                         "pressure of the water at a soil particle, Eq. 47"};
inline constexpr FieldSpec saturation{"saturation", scalar, state, unit::none,
                                      "degree of saturation S_r, Eq. 68"};

// Water in soil.
inline constexpr FieldSpec water_fraction{"water_fraction", scalar, derived, unit::none,
                                          "share of the volume that water can take, n^w, Eq. 56"};
inline constexpr FieldSpec soil_sum{
    "soil_sum", scalar, derived, unit::none,
    "sum of the grains' volume over soil neighbors, without the walls' share"};
inline constexpr FieldSpec inverse_soil_mass{
    "inverse_soil_mass", scalar, derived, unit::inverse_mass,
    "1 / mass of the soil that a water particle moves by its drag"};
inline constexpr FieldSpec drag_linear{"drag_linear", scalar, derived, unit::drag_linear,
                                       "drag per volume and relative velocity, Eqs. 29, 31"};
inline constexpr FieldSpec drag_quadratic{
    "drag_quadratic", scalar, derived, unit::drag_quadratic,
    "drag per volume and square of the relative velocity, Eq. 31"};
inline constexpr FieldSpec pressure_force{"pressure_force", vector, derived, unit::force_density,
                                          "minus the gradient of the water pressure"};
inline constexpr FieldSpec soil_velocity{"soil_velocity", vector, derived, unit::speed,
                                         "velocity of the soil at a water particle, Eq. 57"};
inline constexpr FieldSpec gradient_scale{"gradient_scale", scalar, state, unit::none,
                                          "root of what the sums of gradients of water in soil are "
                                          "multiplied by to see a linear field as it is"};
inline constexpr FieldSpec drag_acceleration{
    "drag_acceleration", vector, state, unit::acceleration,
    "acceleration of water by drag in the last acoustic step"};

// Solids.
inline constexpr FieldSpec reference_volume{"reference_volume", scalar, reference, unit::volume,
                                            "volume at t = 0; an area in 2D"};
inline constexpr FieldSpec clamp{
    "clamp", tag, reference, unit::none,
    "index of the clamped region of its body, -1 where the body is free"};
inline constexpr FieldSpec reference_correction{
    "reference_correction", tensor, derived, unit::none,
    "inverse moment of the kernel gradient at rest, Eq. 66: xx, yy, zz, xy, yz, xz"};
inline constexpr FieldSpec source{
    "source", tag, reference, unit::none,
    "id of the particle of a solid that a interface particle follows"};
inline constexpr FieldSpec source_set{"source_set", tag, reference, unit::none,
                                      "number of that solid's set"};
// Saved: a probe that is due right after a run went on reads those of the step before.
inline constexpr FieldSpec water_force{
    "water_force", vector, state, unit::force,
    "force of water on a particle of a wall or of the interface"};
inline constexpr FieldSpec soil_force{"soil_force", vector, state, unit::force,
                                      "force of soil on a particle of a wall or of the interface"};
inline constexpr FieldSpec mean_water_force{"mean_water_force", vector, state, unit::force,
                                            "water_force, mean over the advection step"};
inline constexpr FieldSpec mean_soil_force{"mean_soil_force", vector, state, unit::force,
                                           "soil_force, mean over the advection step"};
inline constexpr FieldSpec contact_force{
    "contact_force", vector, state, unit::force,
    "force of other solids and of walls on a interface particle"};
inline constexpr FieldSpec mean_contact_force{"mean_contact_force", vector, state, unit::force,
                                              "contact_force, mean over the advection step"};
inline constexpr FieldSpec contact_energy{
    "contact_energy", scalar, state, unit::energy,
    "energy stored in the contacts of a interface particle; J per metre of depth in 2D"};
inline constexpr FieldSpec fluid_force{"fluid_force", vector, derived, unit::force,
                                       "force of water and soil on a particle of a solid"};
inline constexpr FieldSpec cauchy_stress{
    "cauchy_stress", tensor, derived, unit::pressure,
    "stress of a solid, tension positive: xx, yy, zz, xy, yz, xz"};
inline constexpr FieldSpec von_mises{"von_mises", scalar, derived, unit::pressure,
                                     "equivalent stress after von Mises"};
inline constexpr FieldSpec strain_energy{
    "strain_energy", scalar, derived, unit::energy,
    "elastic energy of a particle, Eq. 39; J per metre of depth in 2D"};

/// All of them, for lookups by name.
inline constexpr const FieldSpec* all[] = {&id,
                                           &part,
                                           &position,
                                           &velocity,
                                           &acceleration,
                                           &acceleration_sum,
                                           &mass,
                                           &density,
                                           &density_rate,
                                           &pressure,
                                           &mean_pressure,
                                           &volume,
                                           &surface,
                                           &normal,
                                           &reference_position,
                                           &displacement,
                                           &reference_normal,
                                           &no_slip,
                                           &corner,
                                           &volume_fraction,
                                           &volume_fraction_rate,
                                           &initial_volume_fraction,
                                           &stress,
                                           &number_density_ratio,
                                           &gradient_correction,
                                           &plastic_strain,
                                           &plastic_work,
                                           &water_acceleration,
                                           &pore_pressure,
                                           &saturation,
                                           &water_fraction,
                                           &soil_sum,
                                           &inverse_soil_mass,
                                           &drag_linear,
                                           &drag_quadratic,
                                           &pressure_force,
                                           &soil_velocity,
                                           &gradient_scale,
                                           &drag_acceleration,
                                           &reference_volume,
                                           &clamp,
                                           &reference_correction,
                                           &fluid_force,
                                           &source,
                                           &source_set,
                                           &water_force,
                                           &soil_force,
                                           &mean_water_force,
                                           &mean_soil_force,
                                           &contact_force,
                                           &mean_contact_force,
                                           &contact_energy,
                                           &cauchy_stress,
                                           &von_mises,
                                           &strain_energy};

}  // namespace sphgeo::fields
