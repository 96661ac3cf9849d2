// parameters.hpp  What an engine may change between steps: how a character's parts swing, and what moves them
// beside their pose.
//
// Changes glide, so that nothing jumps: 5 % of the way to what was set are left after 12 ticks. From extreme
// to extreme some take longer: a soft part's stiffness becomes ten times another in 19 ticks and what the
// glide takes at its ends, a rod's in 38; displacement goes from 0 to 4 in 33. What an instance was given is
// part of its snapshot, and so is how far it has come; the world's Environment is the world's and in no
// snapshot. A number at its default costs nothing.
#pragma once

namespace sinew {

// How a soft part or a rod swings, as shares of what was baked. NaN: kNotFinite; out of range:
// kInvalidArgument.
struct PartParameters {
  // 0..2, share of its swing that is shown. It swings on beneath: 0 shows the pose, at the cost of 1. Of a
  // bone that goes beyond half a turn against its pose (a limp rod) a share other than 0, 1 or 2 changes
  // sides there, at once.
  float intensity = 1;
  // 0.01..100, of the baked stiffness: its frequencies go with the root of it, and what a load that lasts
  // moves it by is divided by it. Of a soft part away from 1 (by a quarter or more) a network corrects
  // nothing.
  float stiffness = 1;
  // 0..100, of the baked damping ratio, at every stiffness. Flesh keeps a ratio of 0.002 at least, a rod's
  // damping_s stays below 30 ticks or as baked. For the network as stiffness.
  float damping = 1;
  // 0..4, of the largest displacement that is shown: of flesh in metres, of rods, where they have a limit, in
  // radians. Beyond 1 flesh may show more than it was baked for, but
  // no vertex more than half of the bind pose's largest extent. Intensity counts after it.
  float displacement = 1;
  // False: it fades to its pose. Then a soft part costs no tick, and rods cost none once all rods of the
  // instance are off; an instance of which nothing is on is skinned. Back on, it comes from rest.
  bool enabled = true;
};

// Air that moves. What it pushes against is counted as standing still where flesh is concerned, and a rod
// feels it less its own velocity. It is felt by a character larger or smaller than it was baked as that one
// feels it.
//   flesh  an acceleration rho/2 c |w| w / (1000 kg/m^3 x the part's radius): at 10 m/s 0.7 m/s^2 of an ear
//          of 0.1 m, next to nothing of a belly
//   rods   a force on each bone rho/2 c |w| (w - v) 2 r l, of w - v what is across the bone
// with rho 1.2 kg/m^3 and c 1.1. Hair that is to feel more than its own strands do wants a larger radius or a
// smaller density in its recipe.
struct Wind {
  float velocity_m_s[3] = {0, 0, 0};  // world, each within +-200; 0: none
  // 0..1, share of the velocity by which gusts change it, up and down. They travel
  // with the wind and are the same whenever it is played: they count from when the instance begins to feel
  // wind, later the further downwind of the world's origin it stands then.
  float gust = 0;
  float gust_hz = 0.5f;  // above 0, up to 10: of the largest gusts; smaller ones come faster
};

// What all of a world's characters feel beside their motion.
struct Environment {
  // World, each within +-1000. Flesh feels its change from the gravity that it was baked under, the default;
  // of rods it takes the place of that gravity, as much of it and as far turned as their recipe says.
  float gravity_m_s2[3] = {0, -9.80665f, 0};
  // World, each within +-10000; of everything that swings (an explosion, a ship that rolls). It is what a
  // root that accelerates the other way makes felt, and bounded as that is (TeleportDef::acceleration).
  float acceleration_m_s2[3] = {0, 0, 0};
  Wind wind = {};
};

// What one instance feels more than its world's Environment: sums. The gusts are the world's.
struct AddedEnvironment {
  float acceleration_m_s2[3] = {0, 0, 0};  // as Environment has it
  float wind_m_s[3] = {0, 0, 0};           // as Wind::velocity_m_s
};

}  // namespace sinew
