// collider_state.hpp  What a collider holds from step to step and within one, by what it is of.
#pragma once
#include <cstdint>

#include "rods/contacts/contact.hpp"
#include "rods/contacts/find/spatial_hash.hpp"
#include "rods/contacts/find/sweep.hpp"
#include "rods/contacts/obstacle.hpp"
#include "sinew/contact_source.hpp"

namespace sinew::rods {

inline constexpr uint32_t kNoContact = ~0u;

// What rods run into, as it was set last.
struct Obstacles {
  Plane* planes = nullptr;
  Sphere* spheres = nullptr;
  Capsule* capsules = nullptr;
  ContactPoint* points = nullptr;
  uint64_t* passed = nullptr;  // [strands][segments]
  uint32_t plane_count = 0, sphere_count = 0, capsule_count = 0, point_count = 0;
  bool passed_any = false;
};

// Contacts of groups that are stepped together; before these, in this step, contacts_before.
struct FoundContacts {
  Contact* contacts = nullptr;  // [capacity]
  uint32_t contact_count = 0, contacts_before = 0, dropped = 0;
};

// A contact's force from step to step, and by how much the last one changed it, whatever its length; 0
// where that was its first, and where it did not converge.
struct KeptForce {
  uint64_t name;
  ForceInNewtons force, change;
};

struct KeptForces {
  KeptForce* kept = nullptr;      // [capacity] in the order of the last step's contacts
  KeptForce* new_kept = nullptr;  // alike, of this step's
  uint32_t new_kept_count = 0;
  // [twice capacity, a power of two] of it in use; where a name's is in kept, from 1 on, 0: nowhere.
  uint32_t* kept_places = nullptr;
  uint32_t kept_count = 0, kept_in_use = 1, kept_next = 0;  // the last: behind what was found last
};

// Groups that are looked at together, one behind the other in the batch and in their places; and what they
// touch. Joined ranges' groups are one behind the other in their places alone.
struct GroupRange {
  uint32_t first_group, groups, first_place;
  uint32_t first_contact, end_contact, first_hit, end_hit;
};

// Places of groups that are stepped together, and those behind them that their strands are packed into.
// What follows by groups is by places of the former; scratch and rows are of the latter too.
struct GroupPlaces {
  GroupRange range = {};
  GroupRange* ranges = nullptr;  // [home_groups]
  uint32_t home_groups = 0, packed_groups = 0, packed_count = 0;
  uint32_t place_count = 0, range_count = 0;  // taken
  uint32_t* homes = nullptr;                  // [home_groups] the group in a place
  uint32_t* seats = nullptr;                  // [strands] place and lane
  float* packed_records = nullptr;            // [packed_groups], as a batch's
  float* packed_lanes = nullptr;              // alike
  float* scratch = nullptr;                   // [groups], as a batch's
};

// Of the range, strands that go on and contacts of such strands, but for those that no iteration got near;
// before these, of the ranges before it.
struct GoingOn {
  uint32_t* strands = nullptr;   // [home_groups][width]
  uint32_t* contacts = nullptr;  // [capacity]
  uint32_t first_strand = 0, strand_count = 0, first_contact = 0, contact_count = 0;
};

// Where segments go in a step, and how far they reach.
struct Reaches {
  Sweep* sweeps = nullptr;         // [segments]
  SweptBox* boxes = nullptr;       // alike
  uint8_t* swept = nullptr;        // alike: its sweep is of this step
  float* reaches = nullptr;        // [groups][slots][kReachRows][width]
  float* reach_boxes = nullptr;    // [groups][kBoxRows][width]
  float* lengths_m = nullptr;      // [groups][width]
  double* origins_m = nullptr;     // [groups][3][width]
  uint16_t* near_lanes = nullptr;  // [slots] of the group that is looked at
  SpatialHash hash;
};

// Contacts' forces as the rods' linear system has them.
struct ForceRows {
  float* rows = nullptr;       // [groups][segments][kRodContactRows][width]
  uint8_t* touched = nullptr;  // [groups][segments]: rows are not zero
  uint32_t* touched_list = nullptr;
  uint32_t touched_count = 0;
};

// How far each strand's iteration has come: [strands].
struct StrandProgress {
  uint8_t* turning = nullptr;   // not converged by themselves
  uint8_t* pending = nullptr;   // not converged by a contact
  double* misses = nullptr;     // what its contacts' forces miss their laws by, kg m
  double* presses = nullptr;    // sum of what presses it, kg m
  double* moves_m = nullptr;    // how far the last iteration moved a point of it, at most
  double* passed_m = nullptr;   // and those before it
  double* clear_m = nullptr;    // where it began, how far it was from what is left out
  double* ways = nullptr;       // where the first iterate is, from the step's start to free motion
  Vector* carries = nullptr;    // what a core moves that stops a strand
  uint8_t* near = nullptr;      // it has contacts, pressed or not
  uint8_t* iterated = nullptr;  // moved by the last iteration
  uint8_t* moved = nullptr;     // since it was last looked at whether it is to be held
};

// What became of a source's hit.
struct TakenHit {
  uint32_t contact;  // kNoContact: left out, or its strand has ended
  Vector felt;       // force on the rod in the last iteration, times the step's square
  Vector point_m;    // of the rod's surface, at the step's end
};

// A contact source, and what it was asked in this step.
struct AskedSource {
  ContactSource* source = nullptr;
  double origin_m[3] = {0, 0, 0};
  uint32_t owner = 0, hit_count = 0, bad_hits = 0;
  ContactProbe* probes = nullptr;      // [segments]
  uint32_t* probe_segments = nullptr;  // alike: as ContactFinder::local
  ContactHit* hits = nullptr;          // [2 source_capacity] of the step; those of a second look behind
  TakenHit* taken = nullptr;           // [source_capacity]
  double* pushes = nullptr;            // [strands] sizes of what its hits felt
  double* hit_ways = nullptr;  // [strands] how far what it was told of moves in the step, the furthest
  double* cores_m = nullptr;   // [segments] radius of what is looked at again, 0: nothing
};

}  // namespace sinew::rods
